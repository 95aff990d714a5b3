//! Arguments whose values a shell completes. The library parses them and words the errors.

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use std::ffi::OsStr;
use std::marker::PhantomData;
use std::str::FromStr;

/// A parser of `T` that offers names for shell completion.
#[derive(Clone)]
pub struct Named<T> {
    names: fn() -> Vec<String>,
    of: PhantomData<T>,
}

impl<T> Named<T> {
    /// A parser that offers these names.
    pub const fn new(names: fn() -> Vec<String>) -> Self {
        Self { names, of: PhantomData }
    }
}

impl<T> TypedValueParser for Named<T>
where
    T: FromStr + Clone + Send + Sync + 'static,
    T::Err: Into<Box<dyn std::error::Error + Send + Sync>>,
{
    type Value = T;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<T, Error> {
        TypedValueParser::parse_ref(&|text: &str| text.parse::<T>(), command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.names)().into_iter().map(PossibleValue::new)))
    }
}

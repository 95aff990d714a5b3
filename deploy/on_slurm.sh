#!/bin/bash
# Tunes a study as a Slurm job array: the shares of its grid, then one merge. From the directory that holds `studies`:
#
#   STUDY=studies/ssvi.json OUT=results/ssvi SHARDS=64 bash deploy/on_slurm.sh
#
# The directory of the results must be one that all nodes see. Start it again after any failure: parts that are there are kept,
# shares that were begun go on, and the merge refuses anything that is not complete.
set -euo pipefail
: "${STUDY:?the study file}" "${OUT:?the directory of the results}" "${SHARDS:?the number of shares}"
export STUDY OUT SHARDS RETUNE="${RETUNE:-retune}" CPUS="${CPUS:-1}"
mkdir -p "$OUT/parts"

array=$(sbatch --parsable --job-name=retune --array="1-$SHARDS" --cpus-per-task="$CPUS" --time="${TIME:-01:00:00}" \
    --requeue --output="$OUT/parts/log-%a.txt" --export=ALL \
    --wrap='exec "$RETUNE" optimize "$STUDY" --out "$OUT" --shard "$SLURM_ARRAY_TASK_ID/$SHARDS" --threads "$CPUS" --quiet --resume')
# afterany, not afterok: the merge says by itself which shares are missing.
sbatch --job-name=retune-merge --dependency="afterany:$array" --cpus-per-task="$CPUS" --time="${TIME:-01:00:00}" \
    --output="$OUT/parts/log-merge.txt" --export=ALL \
    --wrap='exec "$RETUNE" merge "$STUDY" --out "$OUT" --threads "$CPUS" --resume'

#!/bin/sh
# SPDX-License-Identifier: MIT
# A sweep as a Slurm array, a cell a task:
#   n=$(SWEEP_ONLY_LIST=1 sweep.sh out data/*.json -- '--cords 1' '--cords 4 --ends feet')
#   sbatch --array=1-"$n" slurm.sh "$PWD/out"
#   sweep.sh out data/*.json -- '--cords 1' '--cords 4 --ends feet'     does what failed, and collects the results
#SBATCH --job-name=thread
#SBATCH --cpus-per-task=1
#SBATCH --mem=2500M
#SBATCH --time=01:00:00
#SBATCH --output=/dev/null
set -eu
# Slurm runs a copy of this file: the script of a cell is looked for where it was submitted.
exec "${SLURM_SUBMIT_DIR:-.}/cell.sh" "$1" "$SLURM_ARRAY_TASK_ID"

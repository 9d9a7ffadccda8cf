#!/usr/bin/env bash
# Runs the odometry on a sequence and writes its report; a job of kitti_benchmark.
#
# usage: run_sequence.sh PROGRAMS SEQUENCE TRUTH RESULT [OPTION of offline_odometry...]
#
# PROGRAMS is the folder of the programs. TRUTH is the file of true poses, the sequence itself, or "none". The
# folder RESULT is created on success; a failure leaves RESULT.log instead, an interrupted run leaves nothing.
set -euo pipefail

programs=$1 sequence=$2 truth=$3 result=$4
shift 4
part=$result.part.$(uname -n).$$
trap 'rm -rf "$part"' EXIT
mkdir -p "$part"
touch "$part/.rotrocc_report"  # evaluate_trajectory may write its report there
rm -f "$result.log"

format=tum
if [ -d "$sequence/image_0" ]; then format=kitti; fi  # as the poses of its truth

run() {
  "$programs/offline_odometry" "$sequence" --trajectory "$part/estimate.txt" --format "$format" \
    --stats "$part/pairs.csv" "$@" || return
  local trajectories=("$truth" "$part/estimate.txt" --fit)
  if [ "$truth" = none ]; then trajectories=("$part/estimate.txt"); fi
  "$programs/evaluate_trajectory" "${trajectories[@]}" --report "$part" \
    --stats "$part/pairs.csv" --title "$(basename "$result")"
}
# In the background, so that bash handles signals while waiting, and in its own process group.
set -m
run "$@" >"$part/log.txt" 2>&1 &
trap 'kill -- -$! 2>/dev/null; exit 130' INT TERM HUP
if ! wait $!; then
  mv "$part/log.txt" "$result.log"
  exit 1
fi
printf 'seconds\n%d\n' "$SECONDS" >"$part/duration.csv"
# Another machine may have finished it first, after a killed run.
mv -T "$part" "$result" 2>/dev/null || [ -d "$result" ]

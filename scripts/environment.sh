# shellcheck shell=bash
# Sourced by the other scripts: paths, usage and build functions.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ROTROCC_BUILD_DIR:-$root/build}
started=$SECONDS
cmake_options=()

# Prints the comment at the top of a script, and ends it with a status.
usage() {
  sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"
  exit "$1"
}

# Ends the script with a message, and a status of 1 unless there is another one.
fail() {
  echo "$(basename "$0"): $1" >&2
  exit "${2:-1}"
}

# Prints a step, with the seconds since the start of the script.
step() {
  printf '[%4d s] %s\n' $((SECONDS - started)) "$*"
}

# Programs of ROS call python3 from PATH; a python of pyenv or conda lacks the ROS modules.
python=$(command -v python3 || true)
export PATH=/usr/bin:$PATH

# Sources a setup.bash of ROS, which does not support set -u.
source_ros() {
  set +u
  # shellcheck disable=SC1090
  . "$1"
  set -u
}

# Reads the output of make, and says how far it is: on a terminal in one line that changes, otherwise in one
# for every 10 %. Warnings are shown.
show_progress() {
  local target=$1 line percent tenths=-1 is_terminal
  [ ! -t 1 ] || is_terminal=yes
  while IFS= read -r line; do
    if [[ $line =~ ^\[\ *([0-9]+)%\] ]]; then
      percent=${BASH_REMATCH[1]}
      if [ -n "${is_terminal:-}" ]; then
        printf '\r[%4d s] building %s: %3d %%' $((SECONDS - started)) "$target" "$percent"
      elif ((percent / 10 > tenths)); then
        tenths=$((percent / 10))
        step "building $target: $percent %"
      fi
    elif [[ $line == *warning:* ]]; then
      echo "${is_terminal:+$'\n'}$line"
    fi
  done
  [ -z "${is_terminal:-}" ] || echo
}

# Configures with cmake_options, builds the given CMake targets (default: all but the tests), and adds
# the package to the ROS environment. With ROTROCC_PREBUILT=1 they are taken as they are.
build_targets() {
  local log=$build/build.log target
  if [ -f /opt/ros/noetic/setup.bash ]; then source_ros /opt/ros/noetic/setup.bash; fi
  if [ -n "${ROTROCC_PREBUILT:-}" ]; then
    source_ros "$build/devel/setup.bash"
    return
  fi
  if [ -n "$python" ] && [ "$(realpath "$python")" != "$(realpath /usr/bin/python3)" ]; then
    step "using the system's /usr/bin/python3, which has ROS, instead of $python"
  fi
  step "configuring and building (log: $log)"
  mkdir -p "$build"
  if ! LC_ALL=C cmake -S "$root" -B "$build" "${cmake_options[@]}" >"$log" 2>&1; then
    build_failed "$log"
  fi
  for target in "${@:-all}"; do
    LC_ALL=C cmake --build "$build" -j"$(nproc)" --target "$target" 2>&1 | tee -a "$log" |
      show_progress "$target" || build_failed "$log"
  done
  source_ros "$build/devel/setup.bash"
}

# Ends with the errors in a log.
build_failed() {
  grep -E -A 5 'error|Error|\*\*\*' "$1" | head -n 40 >&2 || true
  fail "the build failed; see $1"
}

# Ends what the script has started and still runs, the latest first.
end_processes() {
  local process
  trap '' INT TERM
  for process in $(jobs -rp | tac); do
    kill "$process" 2>/dev/null || true
    wait "$process" 2>/dev/null || true
  done
}

# Prints the failed and skipped tests in a folder of results, and sets tests_passed and tests_failed.
count_tests() {
  local summary
  summary=$(python3 "$root/scripts/rotrocc_tools/test_summary.py" "$1")
  sed '$d' <<<"$summary"
  # shellcheck disable=SC2034
  read -r tests_passed tests_failed <<<"${summary##*$'\n'}"
}

# Uses a free port for a separate ROS master, so that scripts do not interfere with a running robot.
use_own_ros_master() {
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
  unset ROS_IP
  export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:$port
  export ROS_LOG_DIR=${ROS_LOG_DIR:-$build/ros_logs}
}

# Starts that master, with a log.
start_ros_master() {
  rosmaster --core -p "${ROS_MASTER_URI##*:}" >"$1" 2>&1 &
  timeout 20 bash -c 'until rosparam list; do sleep 0.2; done' >/dev/null 2>&1 ||
    fail "the ROS master does not start; see $1"
}

# shellcheck shell=bash
# Sourced by the scripts beside it: where things are, and how to build them.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ROTROCC_BUILD_DIR:-$root/build}
started=$SECONDS
cmake_options=()

# Announces a step, with the seconds since the script began.
step() {
  printf '[%4d s] %s\n' $((SECONDS - started)) "$*"
}

# ROS's CMake files call python3 from PATH: a python of pyenv or conda there has none of ROS's modules.
python=$(command -v python3 || true)
if [ -n "$python" ] && [ "$(realpath "$python")" != "$(realpath /usr/bin/python3)" ]; then
  step "using the system's /usr/bin/python3, which has ROS, instead of $python"
fi
export PATH=/usr/bin:$PATH

# Sources a setup.bash of ROS, which are not written for set -u.
source_ros() {
  set +u
  # shellcheck disable=SC1090
  . "$1"
  set -u
}

if [ -f /opt/ros/noetic/setup.bash ]; then source_ros /opt/ros/noetic/setup.bash; fi

# Configures, with cmake_options, and builds the CMake targets given, or all but the tests. Then our
# programs and packages can be found.
build_targets() {
  local log=$build/build.log
  step "building (log: $log)"
  mkdir -p "$build"
  if ! { cmake -S "$root" -B "$build" -DPYTHON_EXECUTABLE=/usr/bin/python3 "${cmake_options[@]}" &&
         cmake --build "$build" -j"$(nproc)" --target "${@:-all}"; } >"$log" 2>&1; then
    grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || true
    echo "$(basename "$0"): the build failed; all of its output is in $log" >&2
    exit 1
  fi
  source_ros "$build/devel/setup.bash"
}

# A port that is free now for a ROS master of our own, so that nothing here meets a running robot.
use_own_ros_master() {
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
  unset ROS_IP
  export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:$port
  export ROS_LOG_DIR=${ROS_LOG_DIR:-$build/ros_logs}
}

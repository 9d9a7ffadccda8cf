# shellcheck shell=bash
# Sourced by the other scripts: paths and build functions.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ROTROCC_BUILD_DIR:-$root/build}
started=$SECONDS
cmake_options=()

# Prints a step, with the seconds since the start of the script.
step() {
  printf '[%4d s] %s\n' $((SECONDS - started)) "$*"
}

# ROS's CMake files call python3 from PATH; a python of pyenv or conda lacks the ROS modules.
python=$(command -v python3 || true)
if [ -n "$python" ] && [ "$(realpath "$python")" != "$(realpath /usr/bin/python3)" ]; then
  step "using the system's /usr/bin/python3, which has ROS, instead of $python"
fi
export PATH=/usr/bin:$PATH

# Sources a setup.bash of ROS, which does not support set -u.
source_ros() {
  set +u
  # shellcheck disable=SC1090
  . "$1"
  set -u
}

if [ -f /opt/ros/noetic/setup.bash ]; then source_ros /opt/ros/noetic/setup.bash; fi

# Configures with cmake_options, builds the given CMake targets (default: all but the tests), and adds
# the package to the ROS environment.
build_targets() {
  local log=$build/build.log
  step "building (log: $log)"
  mkdir -p "$build"
  if ! { cmake -S "$root" -B "$build" -DPYTHON_EXECUTABLE=/usr/bin/python3 "${cmake_options[@]}" &&
         cmake --build "$build" -j"$(nproc)" --target "${@:-all}"; } >"$log" 2>&1; then
    grep -E -A 5 'error|Error' "$log" | head -n 40 >&2 || true
    echo "$(basename "$0"): the build failed; see $log" >&2
    exit 1
  fi
  source_ros "$build/devel/setup.bash"
}

# Uses a free port for a separate ROS master, so that scripts do not interfere with a running robot.
use_own_ros_master() {
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
  unset ROS_IP
  export ROS_HOSTNAME=localhost ROS_MASTER_URI=http://localhost:$port
  export ROS_LOG_DIR=${ROS_LOG_DIR:-$build/ros_logs}
}

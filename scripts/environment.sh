# Sourced by the scripts beside it: where things are, and how to build them.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ROTROCC_BUILD_DIR:-$root/build}

# ROS's CMake files call python3 from PATH: a pyenv or conda python in front of the system's has none
# of its modules.
if [ "$(command -v python3 || true)" != /usr/bin/python3 ]; then
  echo "rotrocc: using /usr/bin/python3 instead of $(command -v python3 || echo none)"
fi
export PATH=/usr/bin:$PATH

if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  . /opt/ros/noetic/setup.bash
  set -u
fi

# Configures and builds everything; $1 is the log.
build_all() {
  echo "rotrocc: building (log: $1)"
  if ! { cmake -S "$root" -B "$build" && cmake --build "$build" -j"$(nproc)"; } >"$1" 2>&1; then
    tail -n 40 "$1" >&2
    echo "rotrocc: the build failed; the whole log is $1" >&2
    exit 1
  fi
  set +u
  . "$build/devel/setup.bash"
  set -u
}

# A ROS master of our own, so that nothing here meets a robot that is running.
use_own_ros_master() {
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://localhost:$port
  export ROS_HOSTNAME=localhost
  export ROS_LOG_DIR=${ROS_LOG_DIR:-$build/ros_logs}
}

# Sets PYTHON_EXECUTABLE and Python3_EXECUTABLE, before catkin does, to a python3 that has ROS's modules. One of conda or pyenv, which
# may be first in PATH, lacks them, and would stay in the cache.
find_program(python_in_path python3)
set(candidates ${PYTHON_EXECUTABLE} ${python_in_path} /usr/bin/python3)
unset(python_in_path CACHE)
foreach(candidate ${candidates})
  set(modules "catkin_pkg, em, genmsg")
  if(candidate STREQUAL /usr/bin/python3)
    set(modules catkin_pkg)  # the others may be in /opt/ros, where catkin finds them
  endif()
  execute_process(
    COMMAND ${candidate} -c "import ${modules}" RESULT_VARIABLE error OUTPUT_QUIET ERROR_QUIET)
  if(error EQUAL 0)
    set(PYTHON_EXECUTABLE ${candidate} CACHE FILEPATH "python3 that has ROS's modules" FORCE)
    break()
  endif()
endforeach()
if(NOT error EQUAL 0)
  message(FATAL_ERROR "None of these has the python modules of catkin: ${candidates}. Install the dependencies "
    "by scripts/setup, or give a python3 that has them by -DPYTHON_EXECUTABLE=PATH")
endif()
set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})  # for ament_cmake, which Debian's pluginlib uses

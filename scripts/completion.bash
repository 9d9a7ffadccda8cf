# shellcheck shell=bash
# Completion of options, values and recordings in bash, also after `rosrun rotrocc`:
#
#   . scripts/completion.bash
#
# Installed as share/bash-completion/completions/rotrocc. A test checks that it knows every option.

# Options of each program. Those with a value end in =.
declare -gA _rotrocc_options=(
  [benchmark]='--repeat= --programs= --config= --set= --against-programs= --against-config= --against-set='
  [check_rig]='--live --duration= --report= --write-camera-info= --imu= --left-image= --right-image= --rectify= --calibration= --config= --set='
  [draw_report]='--title='
  [evaluate_trajectory]='--lengths= --step= --fit --times= --segments= --report= --stats= --title='
  [kitti_benchmark]='--output= --jobs= --sshlogin= --config= --set= --compare= --title= --programs='
  [kitti_odometry]=''
  [offline_odometry]='--trajectory= --format= --config= --set= --stats= --bag= --pictures= --left-image=
    --right-image= --rectify= --calibration= --imu= --imu-rotation= --preload'
  [publish_camera_info]=''
  [rig_view]=''
  [sequence_to_bag]='--start-time= --rectify --max-stamp-difference='
  [simulate_drive]='--layout= --poses= --times= --frames= --rate= --seed= --noise-seed= --moving-share= --truth --imu
    --size= --focal= --baseline= --rig= --lens= --disparity-bias= --right-rotation= --right-focal= --rows= --time-skew= --noise=
    --motion-blur= --lorry= --lorry-across= --tiles='
  [stress_sequence]='--plain= --drops= --gain-step= --contrast= --right-gain= --right-offset= --noise= --jpeg= --seed='
)

# What an option or the first argument of a program takes, if it is neither a file nor a number.
declare -gA _rotrocc_values=(
  ['check_rig --rectify']='auto yes no'
  ['offline_odometry --format']='kitti tum'
  ['offline_odometry --rectify']='auto yes no'
  ['simulate_drive']='city motorway slip_road parking shake handheld night hall'
  ['simulate_drive --layout']='kitti asl'
  ['simulate_drive --lens']='radtan equidistant'
  ['simulate_drive --rig']='perfect worn'
)
_rotrocc_readers=' benchmark kitti_benchmark kitti_odometry offline_odometry sequence_to_bag stress_sequence '

# Recordings: sequences, bags, and the folders that lead to them.
_rotrocc_recordings() {
  local folder
  compopt -o nospace
  mapfile -t COMPREPLY < <(
    compgen -d -- "$1" | while read -r folder; do
      if [ -d "$folder/image_0" ] || [ -d "$folder/mav0" ] || [ -f "$folder/left.yaml" ]; then
        echo "$folder "
      else
        echo "$folder/"
      fi
    done
    compgen -f -X '!*.bag' -- "$1" | sed 's/$/ /')
}

# Completes the word CWORD of the words that follow: a program and its arguments.
_rotrocc_complete() {
  local cword=$1 program=${2##*/}
  shift
  local words=("$@")
  local word=${words[cword]} previous=${words[cword - 1]}
  local options=" ${_rotrocc_options[$program]//$'\n'/ } "
  local values=${_rotrocc_values[$program $previous]-}
  if [[ $options != *" $previous= "* ]]; then
    if [[ $word == -* ]]; then
      mapfile -t COMPREPLY < <(compgen -W "${options//=/} --help" -- "$word")
      return
    fi
    if [ "$cword" -eq 1 ]; then values=${_rotrocc_values[$program]-}; fi
    if [ -z "$values" ] && [[ $_rotrocc_readers == *" $program "* ]]; then
      _rotrocc_recordings "$word"
      return
    fi
  fi
  if [ -n "$values" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}

_rotrocc_program() { _rotrocc_complete "$COMP_CWORD" "${COMP_WORDS[@]}"; }

# rosrun rotrocc PROGRAM ...; what is before and other packages are left to the completion of ROS.
_rotrocc_rosrun() {
  if [ "$COMP_CWORD" -eq 2 ] && [ "${COMP_WORDS[1]}" = rotrocc ]; then
    mapfile -t COMPREPLY < <(compgen -W "${!_rotrocc_options[*]}" -- "${COMP_WORDS[2]}")
  elif [ "$COMP_CWORD" -gt 2 ] && [ "${COMP_WORDS[1]}" = rotrocc ] &&
      [ -n "${_rotrocc_options[${COMP_WORDS[2]}]+known}" ]; then
    _rotrocc_complete $((COMP_CWORD - 2)) "${COMP_WORDS[@]:2}"
  elif [ -n "$_rotrocc_other_rosrun" ]; then
    "$_rotrocc_other_rosrun" "$@"
  fi
}

if [[ $(complete -p rosrun 2>/dev/null) =~ -F\ ([^ ]+) && ${BASH_REMATCH[1]} != _rotrocc_rosrun ]]; then
  _rotrocc_other_rosrun=${BASH_REMATCH[1]}
fi
: "${_rotrocc_other_rosrun:=}"
complete -F _rotrocc_rosrun rosrun
# `benchmark` alone may be another program.
for _rotrocc_name in "${!_rotrocc_options[@]}"; do
  [ "$_rotrocc_name" = benchmark ] || complete -F _rotrocc_program "$_rotrocc_name"
done
unset _rotrocc_name

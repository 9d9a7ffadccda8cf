"""Runs of the odometry as a nodelet and as a node, for scripts/performance."""
import collections
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import time

import numpy

from odometry_runs import count_pairs, take_pairs

RATE_HZ = 10.0
MODES = ['nodelet', 'node over TCP']
PARTS = ['waiting', 'conversion', 'publishing', 'rest']
QUANTILES = [50, 95, 99]
SETTLING_PAIRS = 5  # at either end
TIMEOUT_S = 60.0
THREADS = collections.OrderedDict([('odometry', '`odometry`: processes pairs'),
                                   ('odometry_help', '`odometry_help`: second thread of the estimator'),
                                   ('odometry_tf', '`odometry_tf`: looks for rival tf')])

Run = collections.namedtuple('Run', 'statuses wakeups')  # status fields of pairs; wake-ups a pair by thread


def back_and_forth(sequence, pairs, target):
    """A folder with so many pairs of a sequence, forwards and backwards, at RATE_HZ."""
    count = count_pairs(sequence)
    loop = list(range(count)) + list(range(count - 2, 0, -1))
    take_pairs(sequence, [loop[i % len(loop)] for i in range(pairs)], target)
    (target / 'times.txt').write_text(''.join('%.6f\n' % (i / RATE_HZ) for i in range(pairs)))
    return target.resolve()


def free_port():
    with contextlib.closing(socket.socket()) as port:
        port.bind(('', 0))
        return port.getsockname()[1]


class Processes:
    """Started in the ROS environment of the programs, with a master of their own; ended in reverse order."""

    def __init__(self, programs, folder):
        self.folder = folder
        self.setup = programs.parent.parent / 'setup.bash'
        port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI='http://localhost:%d' % port,
                                ROS_HOSTNAME='localhost', ROS_LOG_DIR=str(folder), ROS_NAMESPACE='stereo')
        self.environment.pop('ROS_IP', None)
        self.started = []
        self.start('roscore', '-p', port)

    def start(self, *command):
        words = ' '.join("'%s'" % word for word in command)
        log = open(str(self.folder / ('%d.log' % len(self.started))), 'wb')
        process = subprocess.Popen(['bash', '-c', ". '%s' && exec %s" % (self.setup, words)], stdout=log,
                                   stderr=subprocess.STDOUT, env=self.environment)
        self.started.append(process)
        return process

    def wait_for(self, condition, what):
        deadline = time.monotonic() + TIMEOUT_S
        while not condition():
            if time.monotonic() > deadline:
                raise RuntimeError('no %s within %g s' % (what, TIMEOUT_S))
            time.sleep(0.05)

    def end(self):
        for process in reversed(self.started):
            process.send_signal(signal.SIGINT)
            process.wait()


def run(programs, drive, mode):
    """The odometry as in one of MODES, while a player sends it all pairs of the drive."""
    print(mode, flush=True)
    with tempfile.TemporaryDirectory() as folder:
        processes = Processes(programs, pathlib.Path(folder))
        try:
            processes.wait_for(lambda: processes.start('rosparam', 'set', '/use_sim_time', 'true').wait() == 0,
                               'ROS master')
            return play(processes, programs, drive, mode)
        finally:
            processes.end()


def play(processes, programs, drive, mode):
    if mode == 'nodelet':
        odometry = processes.start('rosrun', 'nodelet', 'nodelet', 'manager', '__name:=manager')
        processes.start('rosrun', 'nodelet', 'nodelet', 'load', 'rotrocc/StereoOdometry', 'manager',
                        '__name:=stereo_odometry')
        player = ['rosrun', 'nodelet', 'nodelet', 'load', 'rotrocc/KittiPlayer', 'manager',
                  '__name:=kitti_player']
    else:
        odometry = processes.start(programs / 'stereo_odometry')
        player = [programs / 'kitti_player']
    statuses = processes.folder / ('%d.log' % len(processes.started))
    processes.start('rostopic', 'echo', '--nostr', '--noarr', 'status')
    # The first status of a node without input comes after a second.
    processes.wait_for(lambda: read_statuses(statuses), 'status')
    processes.start(*player, '_bag:=%s' % drive, '_lockstep:=true')
    pairs = count_pairs(drive)
    snapshots = []
    for wanted in (SETTLING_PAIRS, pairs - SETTLING_PAIRS):
        deadline = time.monotonic() + TIMEOUT_S + pairs / RATE_HZ
        while len(of_pairs(read_statuses(statuses))) < wanted and time.monotonic() < deadline:
            time.sleep(0.2)
        snapshots.append((len(of_pairs(read_statuses(statuses))), wakeups(odometry.pid)))
    (pairs_before, before), (pairs_after, after) = snapshots
    if pairs_after <= pairs_before:
        raise RuntimeError('no odometry of %s as a %s' % (drive, mode))
    per_pair = {thread: (count - before.get(thread, 0)) / (pairs_after - pairs_before)
                for thread, count in after.items()}
    return Run(of_pairs(read_statuses(statuses))[SETTLING_PAIRS:], per_pair)


def read_statuses(path):
    """{field: number} of each status in the output of rostopic."""
    text = path.read_text()
    return [{name: float(number) for name, number in re.findall(r'^(\w+): ([-+.\de]+)$', part, re.MULTILINE)}
            for part in text.split('---\n')[:-1]]


def of_pairs(statuses):
    return [status for status in statuses if status.get('latency', 0.0) > 0.0]


def wakeups(pid):
    """How often the threads of each name have waited for something."""
    counts = collections.Counter()
    for task in pathlib.Path('/proc/%d/task' % pid).iterdir():
        count = int(re.search(r'^voluntary_ctxt_switches:\s+(\d+)', (task / 'status').read_text(),
                              re.MULTILINE).group(1))
        counts[(task / 'comm').read_text().strip()] += count
    return counts


def arrival_table(runs):
    def cells(values_of):
        return ['%.3f' % number for one in runs
                for number in numpy.percentile([values_of(status) for status in one.statuses], QUANTILES)]

    rows = [[part] + cells(lambda status, name='time_' + part: status[name]) for part in PARTS]
    rows.append(['**the node: all of these**'] + cells(lambda s: s['latency'] - s['time_total']))
    rows.append(['estimator'] + cells(lambda status: status['time_total']))
    rows.append(['before: from the first image to the second'] + cells(lambda status: status['time_pairing']))
    header = ['ms a pair'] + ['%s: p%d' % (mode, quantile) for mode in MODES for quantile in QUANTILES]
    return header, rows


def wakeup_table(runs):
    rows = [[label] + ['%.1f' % one.wakeups.get(thread, 0.0) for one in runs] for thread, label in THREADS.items()]
    rows.append(['those of roscpp'] + ['%.1f' % sum(count for thread, count in one.wakeups.items()
                                                    if thread not in THREADS) for one in runs])
    return ['wake-ups a pair'] + MODES, rows

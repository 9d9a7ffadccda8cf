"""Plays a bag to an odometry, calls its services, and watches it and its process, for scripts/soak:
soak_watch.py PID BAG SECONDS RATE."""
import re
import statistics
import subprocess
import sys
import time

import numpy
import psutil
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from rotrocc.msg import OdometryStatus
from rotrocc.srv import SaveTrajectory, SetPose
from std_srvs.srv import SetBool, Trigger

SERVICES = [('reset', Trigger, ()), ('pause', SetBool, (True,)), ('pause', SetBool, (False,)),
            ('set_pose', SetPose, ()), ('save_trajectory', SaveTrajectory, ('/no/such/directory/poses.txt', 'tum'))]
SETTLE_S, LEAST_LENGTH_S, MAX_SLOPE_MB_PER_H = 300.0, 600.0, 1.0  # of the memory


class Watch:
    """What the odometry says of itself."""
    def __init__(self):
        self.received, self.status, self.is_found = {}, OdometryStatus(), False
        rospy.Subscriber('status', OdometryStatus, self.on_status)
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics)

    def on_status(self, status):
        self.status = status
        self.is_found |= status.state == OdometryStatus.OK

    def on_diagnostics(self, message):
        for entry in (entry for status in message.status for entry in status.values):
            total = re.search(r'(\d+) in total', entry.value)
            if 'image_rect' in entry.key and total:
                self.received[entry.key] = int(total.group(1))

    def images(self):
        """Images that were received, used, and dropped by reason."""
        weights = {'camera_info_invalid': 0, 'no_partner': 1, 'partner_dropped': 1}
        return (sum(self.received.values()), 2 * self.status.pairs_processed,
                {drop.reason: drop.count * weights.get(drop.reason, 1 if drop.reason.startswith('stamp_') else 2)
                 for drop in self.status.drops})

    def adds_up(self):
        received, used, dropped = self.images()
        return received > 0 and received == used + sum(dropped.values())


def growth_of(samples):
    """Growth [MB/h] of samples (time [s], memory [MB], ...). What leaks raises both maxima and minima: it is the
    smaller of their slopes over the quarters of a run. Maxima alone rise with the load of the machine, minima alone
    if less of what is freed goes back to the system."""
    parts = [part[:, :2] for part in numpy.array_split(numpy.array(samples), 4)]
    middles_s = [part[:, 0].mean() for part in parts]
    return min(3600.0 * numpy.polyfit(middles_s, [extreme(part[:, 1]) for part in parts], 1)[0]
               for extreme in (numpy.min, numpy.max))


def faults_of(samples):
    """Prints memory and threads (third column), and returns what is wrong with them."""
    if len(samples) < 10:
        return ['the run was too short']
    length_s = samples[-1][0]
    is_long = length_s >= LEAST_LENGTH_S
    settled = [s for s in samples if s[0] >= (SETTLE_S if is_long else length_s / 3)]
    slope = growth_of(settled)
    # A thread that is there for a moment does not count.
    middle = len(settled) // 2
    before, after = (statistics.median_high(s[2] for s in half) for half in (settled[:middle], settled[middle:]))
    print(f'memory {settled[-1][1]:.1f} MB, at most {max(s[1] for s in samples):.1f} MB, {slope:+.2f} MB an hour; '
          f'threads {before:.0f}, then {after:.0f}' + ('' if is_long else ' (too short a run to count)'))
    if not is_long:
        return []
    return (['memory grows'] if slope >= MAX_SLOPE_MB_PER_H else []) + (
        ['threads are added'] if after > before else [])


def main(pid, bag, seconds, rate):
    process = psutil.Process(int(pid))
    rospy.init_node('soak')
    watch = Watch()
    rospy.wait_for_service('stereo_odometry/pause', 60.0)
    calls = [(rospy.ServiceProxy('stereo_odometry/' + name, kind, persistent=True), request)
             for name, kind, request in SERVICES]
    samples, faults, begin, plays = [], [], time.monotonic(), 0

    def play(*options):
        watch.is_found = False
        player = subprocess.Popen(['rosbag', 'play', '--clock', bag, *options], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL)
        while player.poll() is None:
            memory = process.memory_info()  # without the files that it has mapped
            samples.append((time.monotonic() - begin, (memory.rss - memory.shared) / 2**20, process.num_threads()))
            call, request = calls[len(samples) % len(calls)]
            call(*request)
            time.sleep(1.0)
        if not watch.is_found:
            faults.append('no motion in a play')

    try:
        while time.monotonic() < begin + float(seconds):
            play('--rate', rate)
            plays += 1
        play('--duration', '3')  # no image waits for a partner
        limit = time.monotonic() + 20.0
        while not watch.adds_up() and time.monotonic() < limit:
            time.sleep(0.5)
    except (psutil.NoSuchProcess, rospy.ServiceException) as error:
        faults.append(f'the odometry does not answer: {error}')
    received, used, dropped = watch.images()
    print(f'{plays} plays, {received} images received, {used} used, dropped: {dropped}')
    faults += ['images are missing'] * (not watch.adds_up()) + faults_of(samples)
    print('\n'.join(sorted(set(faults))))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))

"""The time from the launch of the odometry to its first messages, with a camera and a ROS master of its own."""
import contextlib
import os
import pathlib
import queue
import re
import signal
import socket
import subprocess
import tempfile
import time
import xmlrpc.client

from nav_msgs.msg import Odometry
import numpy
import rospy

NAMESPACE = 'stereo'
TIMEOUT_S = 60


@contextlib.contextmanager
def process(command, **environment):
    """A process with its children, which end with it."""
    started = subprocess.Popen([str(part) for part in command], start_new_session=True,
                               env=dict(os.environ, **environment),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        for number in signal.SIGINT, signal.SIGKILL:
            with contextlib.suppress(ProcessLookupError, subprocess.TimeoutExpired):
                os.killpg(started.pid, number)
                started.wait(TIMEOUT_S)


@contextlib.contextmanager
def ros_master():
    """On a free port, so that a running robot is not touched."""
    with socket.socket() as free:
        free.bind(('', 0))
        port = free.getsockname()[1]
    os.environ.pop('ROS_IP', None)
    with tempfile.TemporaryDirectory() as logs:
        os.environ.update(ROS_HOSTNAME='localhost', ROS_MASTER_URI='http://localhost:%d' % port, ROS_LOG_DIR=logs)
        with process(['roscore', '-p', port]):
            yield


def wait_for_master():
    while True:
        try:
            return rospy.get_master().getPid()
        except OSError:
            time.sleep(0.1)


def libraries_and_memory_mb(node):
    """Of the process that a node or nodelet runs in."""
    api = rospy.get_master().lookupNode('/%s/%s' % (NAMESPACE, node))[2]
    folder = pathlib.Path('/proc/%d' % xmlrpc.client.ServerProxy(api).getPid('/benchmark')[2])
    libraries = set(re.findall(r'/\S+\.so[.0-9]*$', (folder / 'maps').read_text(), re.MULTILINE))
    kilobytes = re.search(r'VmHWM:\s+(\d+)', (folder / 'status').read_text()).group(1)
    return len(libraries), int(kilobytes) / 1024


def start(command, node, arrivals):
    """Seconds until the first and the second odometry, libraries, and memory [MB]."""
    while not arrivals.empty():
        arrivals.get()
    begin = time.monotonic()
    with process(command, ROS_NAMESPACE='' if command[0] == 'roslaunch' else NAMESPACE):
        try:
            first, second = arrivals.get(timeout=TIMEOUT_S), arrivals.get(timeout=TIMEOUT_S)
        except queue.Empty:
            raise RuntimeError('no odometry within %d s' % TIMEOUT_S)
        return (first - begin, second - begin, *libraries_and_memory_mb(node))


def start_in_turns(programs, sequence, repeat):
    """{name: figures of each start}, of the node and of the launch file, while a player repeats the sequence."""
    ways = {'stereo_odometry': ([programs.find('stereo_odometry')], 'stereo_odometry'),
            'stereo_odometry.launch': (['roslaunch', 'rotrocc', 'stereo_odometry.launch'], 'stereo_manager')}
    rospy.init_node('benchmark', disable_signals=True)
    rospy.set_param('/use_sim_time', True)
    arrivals = queue.Queue()
    rospy.Subscriber('/%s/odom' % NAMESPACE, Odometry, lambda _: arrivals.put(time.monotonic()), tcp_nodelay=True)
    camera = [programs.find('kitti_player'), '_bag:=%s' % sequence.resolve(), '_lockstep:=false', '_loop:=true']
    with process(camera, ROS_NAMESPACE=NAMESPACE):
        start(*ways['stereo_odometry'], arrivals)  # the player begins when all topics have a subscriber
        starts = [[start(*way, arrivals) for way in ways.values()] for _ in range(repeat)]
    with contextlib.suppress(AttributeError):  # rospy of Debian 11 calls what its Python no longer has
        rospy.signal_shutdown('done')
    return dict(zip(ways, zip(*starts)))


def describe(values):
    return '%.2f (%.2f to %.2f)' % (numpy.median(values), min(values), max(values))


def measure(programs, sequence, repeat):
    """Prints medians of all starts with their range. The second odometry has the first motion."""
    if not sequence.exists():
        raise RuntimeError('%s does not exist' % sequence)
    with ros_master():
        wait_for_master()
        results = start_in_turns(programs, sequence, repeat)
    print('%-24s %-24s %-24s %9s %11s' % ('', 'first odometry [s]', 'first motion [s]', 'libraries', 'memory [MB]'))
    for name, starts in results.items():
        first, second, libraries, memory = zip(*starts)
        print('%-24s %-24s %-24s %9d %11.1f' % (name, describe(first), describe(second), max(libraries), max(memory)))

"""Simulated drives and runs of the programs, shared by the experiment scripts."""
import collections
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy

SCRIPTS = pathlib.Path(__file__).resolve().parent
PAPER_CONFIG = SCRIPTS.parent / 'config/paper.yaml'
SCENARIOS = ['city', 'motorway', 'slip_road', 'parking', 'shake']
LENGTHS_M = [10, 20, 50, 100, 200]  # segments of simulated drives, where they fit
CLIP_LENGTHS_M = [5, 10, 20, 30, 40]  # those of real clips
STEP = 5  # segments start at every STEP-th pair

Clip = collections.namedtuple('Clip', 'folder lengths_m')


def clip_of(text):
    """FOLDER or FOLDER:LENGTHS, with the lengths of its segments [m]."""
    folder, _, lengths = text.partition(':')
    return Clip(pathlib.Path(folder).resolve(),
                [float(length) for length in lengths.split(',')] if lengths else CLIP_LENGTHS_M)


class Programs:
    """Runs the programs of the package."""

    def __init__(self, folder=None):
        own = pathlib.Path(sys.argv[0]).resolve().parent  # catkin installs scripts there as well
        self.folders = [folder] if folder else [own, SCRIPTS.parent / 'build/devel/lib/rotrocc']

    def run(self, name, *arguments):
        command = [str(part) for part in (self.find(name), *arguments)]
        return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout.decode()

    def find(self, name):
        """The path of a program."""
        for folder in self.folders:
            if (folder / name).is_file():
                return folder / name
        raise RuntimeError('%s is not built; run scripts/test or cmake --build build' % name)

    def simulate(self, target, arguments):
        """Renders a drive unless it exists."""
        if target.is_dir():
            return
        print('rendering', target.name, flush=True)
        part = target.with_name(target.name + '.part')
        self.run('simulate_drive', *arguments, part)
        os.replace(str(part), str(target))

    def estimate(self, sequence, trajectory, *options):
        """Writes the estimated trajectory; returns the number of lost pairs."""
        report = self.run('offline_odometry', sequence, '--trajectory', trajectory, *options)
        return int(re.search(r'(\d+) lost', report).group(1))

    def segments(self, sequence, trajectory, table, lengths_m, step):
        """The errors of all segments, also written to `table`: first_pose, length_m, speed_mps,
        translation_percent, rotation_deg_per_m."""
        self.run('evaluate_trajectory', sequence / 'poses.txt', trajectory,
                 '--times', sequence / 'times.txt', '--step', step, '--segments', table,
                 '--lengths', *lengths_m)
        return [{name: float(value) for name, value in row.items()} for row in read_table(table)]


def take_pairs(sequence, taken, target):
    """A folder with some pairs of a sequence."""
    shutil.rmtree(str(target), ignore_errors=True)
    for side in ('image_0', 'image_1'):
        (target / side).mkdir(parents=True)
        images = sorted((sequence / side).iterdir())
        for index, image in enumerate(images[pair] for pair in taken):
            (target / side / ('%06d%s' % (index, image.suffix))).symlink_to(image.resolve())
    (target / 'calib.txt').write_text((sequence / 'calib.txt').read_text())
    for name in ('times.txt', 'poses.txt'):
        lines = (sequence / name).read_text().splitlines(True)
        (target / name).write_text(''.join(lines[pair] for pair in taken))
    return target


def count_pairs(sequence):
    return len((sequence / 'times.txt').read_text().splitlines())


def take_every(sequence, every, target):
    """A folder with each `every`-th pair of a sequence."""
    return take_pairs(sequence, range(0, count_pairs(sequence), every), target)


def read_table(path):
    with open(str(path)) as file:
        return list(csv.DictReader(file))


def write_table(path, names, rows):
    with open(str(path), 'w') as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows(rows)


def read_poses(path):
    """n x 3 x 4."""
    return numpy.loadtxt(str(path)).reshape(-1, 3, 4)


def add_drive_arguments(parser):
    """Adds the arguments of make_drives()."""
    parser.add_argument('--output', type=pathlib.Path, required=True, help='output folder')
    parser.add_argument('--scenarios', nargs='*', default=SCENARIOS, help='scenarios of simulate_drive')
    parser.add_argument('--poses', nargs='*', type=pathlib.Path, default=[], metavar='FILE',
                        help='KITTI pose files to build streets along')
    parser.add_argument('--times', type=pathlib.Path, metavar='DIR',
                        help='folder with a times file per pose file (default: 10 Hz)')
    parser.add_argument('--frames', type=int, help='render only this many pairs of each drive')
    parser.add_argument('--pose-frames', type=int, help='the same for drives along pose files')
    parser.add_argument('--cache', type=pathlib.Path,
                        help='folder for the drives; existing ones are reused')
    parser.add_argument('--programs', type=pathlib.Path, help='folder of the programs')


def cache_folder(options):
    cache = options.cache or options.output / 'drives'
    cache.mkdir(parents=True, exist_ok=True)
    return cache


def make_drives(programs, options):
    """Folders of all drives; renders missing ones."""
    cache = cache_folder(options)
    frames = ['--frames', options.frames] if options.frames else []
    drives = collections.OrderedDict((cache / name, [name, *frames]) for name in options.scenarios)
    for poses in options.poses:
        times = ['--times', options.times / poses.name] if options.times else []
        length = ['--frames', options.pose_frames or options.frames]
        drives[cache / ('along_' + poses.stem)] = ['--poses', poses, *times,
                                                   *(length if length[1] else [])]
    for drive, arguments in drives.items():
        programs.simulate(drive, arguments)
    return list(drives)


def clips_of(folder):
    return sorted(path.parent for path in folder.glob('*/poses.txt')) if folder else []


def markdown(header, rows):
    return ''.join('| %s |\n' % ' | '.join(str(cell) for cell in cells)
                   for cells in [header, ['---'] * len(header), *rows])


def update_report(report, tables):
    """Replaces the text between the markers of each table."""
    text = report.read_text()
    for name, (header, rows) in tables.items():
        begin, end = '<!-- table %s -->\n' % name, '<!-- end of %s -->' % name
        if begin not in text or end not in text:
            raise RuntimeError('%s has no markers for the table %s' % (report, name))
        text = text[:text.index(begin) + len(begin)] + markdown(header, rows) + text[text.index(end):]
    report.write_text(text)

"""Speed measurements, shared by the scripts."""
import collections
import pathlib
import re
import subprocess
import tempfile

import numpy

from odometry_runs import Programs, read_table

STAGES = ['pyramids', 'corners', 'disparity', 'tracking', 'estimation']
WALL, CPU, MEMORY, ERROR = ('wall mean [ms]', 'cpu mean [ms]', 'odometry memory [MB]',
                            'translation error [%]')
P95 = 'wall p95 [ms]'
P99 = 'wall p99 [ms]'
MEDIAN = 'wall median [ms]'
LATENCY = 'latency mean [ms]'
FIRST_LATENCY = 'latency of the first motion [ms]'


class Setting:
    """A build and its parameters."""

    def __init__(self, programs=None, config=None, assignments=()):
        self.programs = Programs(programs)
        self.options = ['--preload']
        if config:
            self.options += ['--config', config]
        for assignment in assignments:
            self.options += ['--set', assignment]

    def measure(self, sequence):
        """Runs the odometry once over a sequence, or a bag, whose images are read beforehand. Returns
        {name: figure}; times are means over the pairs unless named otherwise."""
        with tempfile.TemporaryDirectory() as folder:
            table, trajectory = (pathlib.Path(folder) / name for name in ('pairs.csv', 'poses.txt'))
            summary = self.run('offline_odometry', sequence, '--trajectory', trajectory,
                               '--stats', table, *self.options)
            pairs = read_table(table)
            figures = self.times(pairs)
            memory = re.search(r'peak memory: ([\d.]+) MB .* of which ([\d.]+) MB', summary)
            figures['process memory [MB]'] = float(memory.group(1))
            figures[MEMORY] = float(memory.group(2))
            figures['pairs lost'] = sum(pair['state'] == 'lost' for pair in pairs)
            error = self.error(sequence, trajectory, pathlib.Path(folder) / 'segments.csv')
            if error is not None:
                figures[ERROR] = error
        return figures

    def run(self, name, *arguments):
        """Output of a program, without its progress."""
        command = [str(part) for part in (self.programs.find(name), *arguments)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.decode().strip())
        return done.stdout.decode()

    @staticmethod
    def times(pairs):
        def column(name):
            return numpy.array([float(pair[name]) for pair in pairs])

        wall = column('wall_ms')
        latency = wall
        if 'prepared_ms' in pairs[0]:  # earlier builds do nothing before a pair arrives
            latency = wall - column('prepared_ms')
        figures = collections.OrderedDict([
            (WALL, wall.mean()), (MEDIAN, numpy.median(wall)),
            (P95, numpy.percentile(wall, 95)), (P99, numpy.percentile(wall, 99)),
            (CPU, column('cpu_ms').mean()), (LATENCY, latency.mean()),
            (FIRST_LATENCY, latency[1] if len(latency) > 1 else float('nan'))])
        for stage in STAGES:
            figures['  %s [ms]' % stage] = column(stage + '_ms').mean()
        figures['features tracked'] = column('tracked').mean()
        figures['features that agree'] = column('rotation_inliers').mean()
        return figures

    def error(self, sequence, trajectory, table):
        """Over 5 to 40 m of short sequences, 100 to 800 m of long ones; None without ground truth."""
        truth = pathlib.Path(sequence) / 'poses.txt'
        if not truth.is_file():
            return None
        self.run('evaluate_trajectory', truth, trajectory, '--fit', '--segments', table)
        errors = [float(row['translation_percent']) for row in read_table(table)]
        return numpy.mean(errors) if errors else None


def measure_in_turns(settings, sequence, repeat):
    """Runs all settings alternately, `repeat` times, so that other load affects all of them. Returns for
    each {name: array of the figures of its runs}."""
    runs = [[] for _ in settings]
    for turn in range(repeat):
        order = list(zip(settings, runs))
        for setting, results in order if turn % 2 == 0 else reversed(order):
            results.append(setting.measure(sequence))
    return [collections.OrderedDict((name, numpy.array([run[name] for run in results]))
                                    for name in results[0]) for results in runs]

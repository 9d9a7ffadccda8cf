"""Runs the programs of the package, with settings of the odometry."""
import os
import pathlib
import shutil
import subprocess
import sys

from rotrocc_tools.tables import read_columns, read_table

ROOT = pathlib.Path(__file__).resolve().parents[2]  # of a checkout
PAPER_CONFIG = ROOT / 'config/paper.yaml'


class Programs:
    """The programs of a folder; by default those beside the command, or in the build of this checkout."""

    def __init__(self, folder=None):
        beside = pathlib.Path(sys.argv[0]).resolve().parent
        self.folders = [folder] if folder else [beside, ROOT / 'build/devel/lib/rotrocc']

    def find(self, name):
        """The path of a program; throws RuntimeError if there is none."""
        for folder in self.folders:
            if (folder / name).is_file():
                return folder / name
        raise RuntimeError('%s is not built; run scripts/test or cmake --build build' % name)

    def run(self, name, *arguments):
        """The output of a program; throws RuntimeError with its messages if it fails."""
        command = [str(part) for part in (self.find(name), *arguments)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.decode().strip() or '%s failed' % ' '.join(command))
        return done.stdout.decode()

    def simulate(self, target, arguments):
        """The folder of a drive, which is rendered unless it exists."""
        def render(part):
            print('rendering', target.name, file=sys.stderr, flush=True)
            self.run('simulate_drive', *arguments, part)
        return make_once(target, render)

    def estimate(self, sequence, folder, *options):
        """Runs the odometry. `folder` gets trajectory.txt and pairs.csv, whose rows are returned."""
        folder.mkdir(parents=True, exist_ok=True)
        try:
            self.run('offline_odometry', sequence, '--trajectory', folder / 'trajectory.txt', '--stats',
                     folder / 'pairs.csv', *options)
        except RuntimeError as error:
            if 'no pair has a motion' not in str(error):  # a result as any other: all are lost
                raise
        return read_table(folder / 'pairs.csv')

    def segments(self, sequence, folder, lengths_m, step):
        """The errors of all segments of the trajectory in `folder`, also written to segments.csv there: arrays of
        first_pose, length_m, speed_mps, translation_percent, rotation_deg_per_m."""
        table = folder / 'segments.csv'
        self.run('evaluate_trajectory', sequence, folder / 'trajectory.txt', '--step', step,
                 '--segments', table, '--lengths', *lengths_m)
        return read_columns(table)


def make_once(target, make):
    """The folder `target`, which make(folder) fills unless it exists. Interrupted, it leaves none of that name."""
    if not target.is_dir():
        part = target.with_name(target.name + '.part')
        shutil.rmtree(str(part), ignore_errors=True)
        make(part)
        os.replace(str(part), str(target))
    return target


def repeated(option, values):
    """A command line with the option for each of the values."""
    return [word for value in values for word in (option, value)]


def odometry_options(setting):
    """The options of offline_odometry for a setting, {parameter: value}; the key config is a file of parameters."""
    return repeated('--config', filter(None, [setting.get('config')])) + repeated('--set', [
        '%s=%s' % (name, str(value).lower() if isinstance(value, bool) else value)
        for name, value in setting.items() if '/' in name])

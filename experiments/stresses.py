"""Stressed drives for experiments/limits: each stress has a ladder of levels, and makes a sequence for each."""
import collections
import io
import threading

import numpy
from PIL import Image, ImageFilter

from drives import change_images, count_pairs, take_every, take_pairs
from rotrocc_tools.programs import make_once

FOCAL_PX, BASELINE_M = 370.0, 0.54
CAMERA = ['--size', '640x240', '--focal', 370, '--baseline', BASELINE_M]  # as KITTI's at half the resolution
PERIOD_S = 0.1
STEP_M = 0.5
START_PAIRS = 5  # speed and turn rate grow from 0 to full during this time
NOISE = 2.0  # [gray levels] of all drives but those of the stress noise
BLUR_TURN_DEG = 4.0  # of a drive with motion blur, per pair

Stress = collections.namedtuple('Stress', 'name title unit levels make')
UNSEEN = ['focal', 'baseline']  # a wrong scale that no image shows
# All levels are measured: a match that survives a large change may fail at a small one.
WHOLE = ['right_gain_down', 'right_gain_up', 'right_offset_down', 'right_offset_up']
LORRIES = ['lorry', 'lorry_across']  # something else fills the image
LORRY_AHEAD_M = 5.0


def ladder(first, last, rungs=17):
    """Levels in equal ratios."""
    return [float('%.3g' % level) for level in numpy.geomspace(first, last, rungs)]


def about(axis, angle_deg):
    """Rotation about a camera's x, y or z axis by each angle, n x 3 x 3."""
    angle = numpy.radians(numpy.asarray(angle_deg, dtype=float))
    rotations = numpy.tile(numpy.eye(3), (len(angle), 1, 1))
    a, b = [(1, 2), (2, 0), (0, 1)]['xyz'.index(axis)]
    rotations[:, a, a] = rotations[:, b, b] = numpy.cos(angle)
    rotations[:, b, a] = numpy.sin(angle)
    rotations[:, a, b] = -numpy.sin(angle)
    return rotations


def grown(pairs):
    """Sum of steps that grow smoothly from 0 to 1 during the start."""
    t = numpy.clip(numpy.arange(1, pairs) / START_PAIRS, 0, 1)
    return numpy.concatenate([[0], numpy.cumsum(t * t * (3 - 2 * t))])


def winding(way_m):
    """Positions and orientations along a road that winds."""
    steps = numpy.diff(way_m, prepend=0)
    heading = 0.25 * numpy.sin(way_m / 9.0)
    positions = numpy.cumsum(steps[:, None] * numpy.stack(
        [numpy.sin(heading), 0 * heading, numpy.cos(heading)], axis=1), axis=0)
    return positions, about('y', numpy.degrees(heading))


class Drives:
    """Makes sequences in a folder, each once."""

    def __init__(self, programs, folder, pairs):
        self.programs = programs
        self.folder = folder
        self.pairs = pairs
        self.locks = {}
        folder.mkdir(parents=True, exist_ok=True)

    def make(self, stress, level, seed):
        return stress.make(self, '%s_%g_%d' % (stress.name, level, seed), level, seed)

    def once(self, name, make):
        """The folder that `make` fills, unless it exists. Stresses that run in parallel share some."""
        with self.locks.setdefault(name, threading.Lock()):
            return make_once(self.folder / name, make)

    def render(self, name, seed, *arguments, turned=None, step_m=STEP_M, noise=NOISE):
        """A drive along a street that winds. At each pose the camera is turned, by n x 3 x 3."""
        def make(target):
            positions, rotations = winding(step_m * grown(self.pairs))
            rotations = rotations if turned is None else rotations @ turned
            poses = self.folder / (name + '.txt')
            numpy.savetxt(str(poses), numpy.dstack([rotations, positions]).reshape(-1, 12), fmt='%.9g')
            self.simulate('--poses', poses, target, '--seed', seed, '--noise', noise, *arguments)
        return self.once(name, make)

    def simulate(self, *arguments):
        self.programs.run('simulate_drive', *CAMERA, '--moving-share', 0, *arguments)

    def round_trip(self, seed):
        """A drive of 18 s with 10 m/s and a turn of 26 deg/s."""
        return self.once('slip_road_%d' % seed, lambda target: self.simulate(
            'slip_road', target, '--seed', seed, '--noise', NOISE))

    def median_depth_m(self, seed):
        """Of what a camera sees on the street, without the sky."""
        drive = self.render('depth_%d' % seed, seed, '--truth')
        depths = numpy.stack([numpy.asarray(Image.open(str(path)))[::4, ::4] for path in
                              sorted((drive / 'depth').iterdir())[::4]])
        return float(numpy.median(depths[depths > 0]))


# What makes the sequence `name` of a stress from a level and a seed.

def turn(axis):
    """A constant turn rate [deg] per pair."""
    return lambda drives, name, level, seed: drives.render(
        name, seed, turned=about(axis, level * grown(drives.pairs)))


def swing(axis, amplitude_deg):
    """Turning back and forth, by at most `level` [deg] per pair."""
    return lambda drives, name, level, seed: drives.render(name, seed, turned=about(
        axis, amplitude_deg * numpy.sin(level / amplitude_deg * grown(drives.pairs))))


def step(drives, name, level, seed):
    return drives.render(name, seed, step_m=level * drives.median_depth_m(seed) / 100)


def each(drives, name, level, seed):
    """Each `level`-th pair of a drive."""
    source = drives.round_trip(seed)
    return drives.once(name, lambda target: take_every(source, int(level), target))


def dropped(drives, name, level, seed):
    """`level` % of the pairs of a drive are missing."""
    source = drives.round_trip(seed)
    kept = numpy.random.RandomState(seed).uniform(size=count_pairs(source)) >= level / 100
    return drives.once(name, lambda target: take_pairs(source, numpy.flatnonzero(kept)[:2 * drives.pairs], target))


def blur(drives, name, level, seed):
    # At a constant rate: in an acceleration, the mean pose of an exposure is not that at its middle.
    exposure_s = level / FOCAL_PX / numpy.radians(BLUR_TURN_DEG) * PERIOD_S
    return drives.render(name, seed, '--motion-blur', '%.6f' % exposure_s,
                         turned=about('y', BLUR_TURN_DEG * numpy.arange(drives.pairs)))


def rendered(option, factor=1.0, *arguments):
    """With an option of simulate_drive."""
    return lambda drives, name, level, seed: drives.render(name, seed, option, '%.6g' % (level * factor), *arguments)


# Places in a line of calib.txt: focal lengths, and focal length times baseline.
FOCAL, BASELINE = (1, 6, 4), (4,)


def miscalibrated(places):
    """With a focal length or a baseline that is `level` % too large."""
    def make(drives, name, level, seed):
        source = drives.render('base_%d' % seed, seed)

        def write(target):
            take_pairs(source, range(count_pairs(source)), target)
            lines = [line.split() for line in (source / 'calib.txt').read_text().splitlines()]
            for words in lines:
                for place in places:
                    words[place] = '%.9g' % (float(words[place]) * (1 + level / 100))
            (target / 'calib.txt').write_text(''.join(' '.join(words) + '\n' for words in lines))
        return drives.once(name, write)
    return make


def worse(change=lambda level, pair, is_right, gray: gray, noise=lambda level: NOISE, quality=None):
    """With worse images: change() of the gray levels, then noise, then a JPEG compression, each by the level."""
    def make(drives, name, level, seed):
        clean = drives.render('clean_%d' % seed, seed, noise=0)
        random = numpy.random.RandomState(seed)

        def worsen(pair, is_right, gray):
            seen = change(level, pair, is_right, gray)
            seen = seen + noise(level) * random.normal(size=gray.shape)
            return through_jpeg(seen, quality(level)) if quality else seen
        return drives.once(name, lambda target: change_images(clean, target, worsen))
    return make


def image_of(gray):
    return Image.fromarray(numpy.rint(gray).clip(0, 255).astype(numpy.uint8))


def through_jpeg(gray, quality):
    file = io.BytesIO()
    image_of(gray).save(file, 'JPEG', quality=quality)
    return numpy.asarray(Image.open(file), dtype=float)


def gain_steps(level, pair, is_right, gray):
    return numpy.minimum(255, gray * numpy.sqrt(level if pair // 5 % 2 else 1 / level))


def right_gain(level, pair, is_right, gray):
    return gray * level if is_right else gray


def right_offset(level, pair, is_right, gray):
    return gray + level if is_right else gray


def contrast(level, pair, is_right, gray):
    return 110 + level / 100 * (gray - 110)


def blurred(gray, sigma_px):
    return numpy.asarray(image_of(gray).filter(ImageFilter.GaussianBlur(sigma_px)), dtype=float)


def plain(level, pair, is_right, gray):
    """Without texture from the left border on."""
    kept = numpy.clip(0.5 + (numpy.arange(gray.shape[1]) - level / 100 * gray.shape[1]) / 24, 0, 1)
    return blurred(gray, 12) + kept * (gray - blurred(gray, 12))


def lorry(across_mps):
    """Broadside ahead, from the left border on; it covers `level` % of the left image at pair 12 of 25."""
    def change(level, pair, is_right, gray):
        px_per_m = FOCAL_PX / LORRY_AHEAD_M
        edge = level / 100 * gray.shape[1] + px_per_m * (across_mps * PERIOD_S * (pair - 12) - BASELINE_M * is_right)
        side = blurred(numpy.random.RandomState(1).uniform(0, 255, (gray.shape[0], 4 * gray.shape[1])), 1.5)
        columns = numpy.arange(gray.shape[1]) - edge
        place = numpy.minimum(columns, -1) + 3 * gray.shape[1]
        whole = place.astype(int)
        tarpaulin = side[:, whole] + (place - whole) * (side[:, whole + 1] - side[:, whole])
        return numpy.where(columns < 0, 90 + 2 * (tarpaulin - 127), gray)
    return change


SHARES = list(range(5, 100, 5))

STRESSES = [
    Stress('turn', 'turn rate', 'deg per pair', ladder(2, 32), turn('y')),
    Stress('swing', 'turning back and forth', 'deg per pair', ladder(1, 24), swing('y', 25.0)),
    Stress('pitch', 'nodding', 'deg per pair', ladder(0.5, 12), swing('x', 10.0)),
    Stress('roll', 'roll rate', 'deg per pair', ladder(2, 32), turn('z')),
    Stress('step', 'step length', '% of the median depth', ladder(4, 64), step),
    Stress('each', 'frame rate', 'every n-th pair', [1, 2, 3, 4, 5, 6, 7, 8, 10, 12], each),
    Stress('dropped', 'pairs dropped', '%', [10, 20, 30, 40, 50, 60, 70, 80, 85, 90, 95], dropped),
    Stress('blur', 'motion blur', 'px', ladder(2, 25), blur),
    Stress('gain_step', 'exposure steps', 'factor', ladder(1.1, 40), worse(gain_steps)),
    Stress('right_gain_down', 'right images: gain below 1', 'factor',
           [0.9, 0.8, 0.7, 0.6, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05, 0.02],
           worse(right_gain)),
    Stress('right_gain_up', 'right images: gain above 1', 'factor',
           [1.15, 1.25, 1.4, 1.7, 2, 2.5, 3.5, 5, 10, 20], worse(right_gain)),
    Stress('right_offset_down', 'right images: offset below 0', 'gray levels',
           [-15, -25, -40, -60, -80, -100, -130, -160, -190], worse(right_offset)),
    Stress('right_offset_up', 'right images: offset above 0', 'gray levels',
           [15, 25, 40, 60, 80, 100, 130, 160, 190, 220], worse(right_offset)),
    Stress('contrast', 'contrast', '%', ladder(80, 1), worse(contrast)),
    Stress('noise', 'noise', 'gray levels', ladder(2, 80), worse(noise=lambda level: level)),
    Stress('jpeg', 'JPEG quality', '', ladder(90, 1), worse(quality=round)),
    Stress('lorry', 'a truck that moves with the camera', '% of the image', SHARES,
           worse(lorry(0.0))),
    Stress('lorry_across', 'a truck that changes lanes', '% of the image', SHARES,
           worse(lorry(1.0))),
    Stress('plain', 'no texture', '% of the image', SHARES, worse(plain)),
    Stress('rows', 'right images: row offset', 'px', ladder(0.25, 16), rendered('--rows')),
    Stress('skew', 'right image late', 'ms', ladder(1, 100), rendered('--time-skew', 1e-3)),
    Stress('focal', 'focal length too large', '%', ladder(0.25, 16), miscalibrated(FOCAL)),
    Stress('baseline', 'baseline too large', '%', ladder(0.25, 16), miscalibrated(BASELINE)),
]

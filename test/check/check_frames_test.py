#!/usr/bin/python3
"""check_frames names the mistakes of wrong programs and accuses no right program.

Usage: check_frames_test.py CHECK_FRAMES EXERCISE3 [FRAMES [SEED [WRONG [RIGHT]]]]
The programs are those of student.py, with random mistakes, scenes and digits.
"""
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import numpy as np

import student
from student import RK4

PROJECT = pathlib.Path(__file__).resolve().parents[2]
METHODS = ('Euler', 'Runge-Kutta-2', 'Runge-Kutta-4')
FORMS = ('4g', '6g', '8g', '17g', '4f', '6f', '8f', 'r')
# A vertical or symmetric scene hides mistakes; these show all.
TELLING_SCENES = ('random_masses', 'heavy_bob', 'random')


def tableau(start, weights):
    return dict(tableau=dict(start=start, weights=weights), method='Runge-Kutta-4')


def wrong(name, **more):
    return dict(wrong=[name], **more)


def single_mistakes(rng):
    """Rows of the name that must be found and the arguments of student.frames."""
    w, half, last = RK4['weights'], (0.5,), (0, 0, 1)
    return [
        ('heun', wrong('heun', method='Runge-Kutta-2')), ('semi_implicit', wrong('semi_implicit')),
        ('semi_implicit_stages', wrong('semi_implicit_stages', method=rng.choice(METHODS[1:]))),
        ('weights', tableau(RK4['start'], (1 / 4, 1 / 4, 1 / 4, 1 / 4))),
        ('weights', tableau(RK4['start'], (1 / 6, 1 / 6, 1 / 3, 1 / 3))),
        ('stage_slope', tableau([(), half, half, last], w)),
        ('stage_slope', tableau([(), half, (0, 0.5), (0, 1, 0)], w)),
        ('stage_fraction', tableau([(), half, (0, 0.5), (0, 0, 0.5)], w)),
        ('damping_not_projected', wrong('damping_not_projected')), ('damping_sign', wrong('damping_sign')),
        ('no_damping', wrong('no_damping')), ('mass_not_divided', wrong('mass_not_divided')),
        ('gravity_divided', wrong('gravity_divided')), ('force_sign', wrong('force_sign')),
        ('one_spring', wrong('one_spring_next')), ('one_spring', wrong('one_spring_previous')),
        ('first_moves', wrong('first_moves')), ('gravity_9.8', dict(g=9.8)),
        ('gravity_10', dict(g=10)), ('gravity_up', dict(g=-9.81)),
        ('g', dict(g=round(rng.uniform(1, 20), 2))), ('k_s', dict(k_s=round(rng.uniform(20, 100), 1))),
        ('k_d', dict(k_d=round(rng.uniform(0.1, 3), 2))), ('L_0', dict(L_0=round(rng.uniform(0.3, 1.5), 2))),
        ('in_place', wrong('in_place', method='Euler')), ('steps_per_frame', dict(steps=rng.choice((9, 11)))),
        ('frame_shift', wrong('frame_late')), ('frame_shift', wrong('frame_early')),
        ('time_step', dict(h=0.1)), ('last_spring', wrong('last_spring')),
        ('every_second_spring', wrong('every_second_spring')), ('mass_of_neighbour', wrong('mass_of_neighbour')),
        ('gravity_on_last', wrong('gravity_on_last')), ('damping_absolute', wrong('damping_absolute')),
        ('three_eighths', tableau([(), (1 / 3,), (-1 / 3, 1), (1, -1, 1)], (1 / 8, 3 / 8, 3 / 8, 1 / 8))),
        ('length_squared', wrong('length_squared')), ('length_integer', wrong('length_integer')),
        ('degrees', wrong('degrees')), ('reversed', wrong('reversed')),
        ('no_motion', wrong('no_motion')), ('swapped', wrong('swapped')),
        ('single_precision', wrong('single_precision'))]


def combined(rng):
    """Two mistakes that do not cancel each other."""
    force = [m for m in single_mistakes(rng) if 'method' not in m[1] and m[0] not in ('single_precision', 'no_motion')]
    fitted = {'k_s', 'k_d', 'L_0', 'g', 'time_step'}
    while True:
        (a, first), (b, second) = rng.sample(force, 2)
        keys = set(first) & set(second) - {'wrong'}
        damping = all('damping' in name or name == 'k_d' for name in (a, b))
        gravity = all(name == 'g' or 'gravity' in name for name in (a, b))
        length = all('length' in name for name in (a, b))
        same = damping or gravity or length or {a, b} <= fitted or {a, b} == {'frame_shift', 'time_step'}
        if a != b and not keys and not same:
            both = dict(first, **second)
            both['wrong'] = first.get('wrong', []) + second.get('wrong', [])
            return (a, b), both


# A mistake in the method and a number.
WITH_NUMBERS = [
    (('stage_slope', 'time_step'), dict(tableau([(), (0.5,), (0, 0.5), (0, 1)], RK4['weights']), h=0.011)),
    (('weights', 'k_s'), dict(tableau(RK4['start'], (1 / 6, 1 / 6, 1 / 3, 1 / 3)), k_s=51.0))]


def random_scene(rng, is_vertical):
    """A chain of springs stretched or compressed a little, vertical ones much, with masses of 0.3 to 2 kg."""
    p = [np.array([0.0, 0.0])]
    for _ in range(rng.randint(2, 9)):
        angle, length = (np.pi / 2, 0.5) if is_vertical else (rng.uniform(-np.pi, 0.5), rng.uniform(0.8, 1.2))
        p.append(p[-1] + length * np.array([np.cos(angle), np.sin(angle)]))
    digits = 20 if is_vertical else 6  # cos(π/2) is no 0
    return np.array([[round(x, digits), round(y, 6), round(rng.uniform(0.3, 2), 2)] for x, y in p])


class Lab:
    def __init__(self, folder, programs, seed):
        self.folder, (self.check, self.exercise) = folder, programs
        self.rng = random.Random(seed)
        self.count = 0

    def scene(self, name):
        """Particles and their file."""
        if name not in ('random', 'vertical'):
            path = PROJECT / 'data' / (name + '.txt')
            return student.read_scene(path), path
        self.count += 1
        path = self.folder / f'scene_{self.count}.txt'
        scene = random_scene(self.rng, name == 'vertical')
        np.savetxt(path, scene, fmt='%.17g')
        return scene, path

    def rng_array(self, shape):
        return np.array([self.rng.random() for _ in range(int(np.prod(shape)))]).reshape(shape)

    def verdict(self, result, form, particles, method, frames=None, *options, first=0):
        self.count += 1
        folder = self.folder / f'frames_{self.count}'
        student.write(folder, result, form, first=first)
        asked = ['--tableau' if isinstance(method, pathlib.Path) else '--method', method] if method else []
        command = [self.check, folder, '--particles', particles, '--frames', str(frames or len(result)), *asked, *options]
        done = subprocess.run(command, stdout=subprocess.PIPE, check=False, universal_newlines=True)
        return done.returncode, done.stdout


def mistakes_in(report):
    """The mistakes of the first explanation."""
    found = re.match('different: .+ with (.+)\n', report)
    return found.group(1).split(' + ') if found else []


def named(names, report):
    """Whether the first explanation names exactly these mistakes, also by fitted values."""
    same = {'gravity_9.8': 'g', 'gravity_10': 'g', 'gravity_up': 'g'}
    return sorted(same.get(name, name) for name in mistakes_in(report)) == sorted(same.get(name, name) for name in names)


def try_wrong(lab, frames, number):
    singles = [((name,), change) for name, change in single_mistakes(lab.rng)]
    programs = singles + WITH_NUMBERS
    right = 0
    for i in range(number):
        # Each of these once, then combinations.
        names, change = programs[i] if i < len(programs) else combined(lab.rng)
        change = dict(change)
        method = change.pop('method', None) or lab.rng.choice(METHODS)
        if names == ('semi_implicit',):
            method = 'Euler'
        scene_name, form = lab.rng.choice(TELLING_SCENES), FORMS[i % len(FORMS)]
        scene, path = lab.scene(scene_name)
        status, verdict = lab.verdict(student.frames(scene, method, count=frames, **change), form, path, method)
        good = status == 4 and named(names, verdict)
        right += good
        if not good:
            print('not named:', names, change, method, scene_name, form, status, verdict, path, sep='  ')
    return right


def exercise_frames(lab, path, method, frames):
    """Frames of Exercise3."""
    lab.count += 1
    folder = lab.folder / f'exercise_{lab.count}'
    subprocess.run([lab.exercise, method, path, '--output', folder, '--frames', str(frames), '--reference', 'never',
                    '--on-divergence', 'continue'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return [np.loadtxt(name, ndmin=2) for name in sorted(folder.iterdir())]


def try_right(lab, frames, number):
    """Half of the programs are those of student.py, half are Exercise3 with every method."""
    listed = subprocess.run([lab.exercise, '--list-methods'], stdout=subprocess.PIPE, check=True).stdout.decode()
    methods = [line.split()[0] for line in listed.splitlines() if line.startswith('  ') and line[2] != ' ']
    scenes = ['random', *3 * ['vertical'], *sorted(path.stem for path in (PROJECT / 'data').glob('*.txt'))]
    accused = 0
    for i in range(number):
        scene_name, form = scenes[i // 2 % len(scenes)], lab.rng.choice(FORMS)
        scene, path = lab.scene(scene_name)
        if i % 2:
            method = lab.rng.choice(METHODS)
            result = student.frames(scene, method, count=frames, wrong=[lab.rng.choice(('', 'angles'))])
        else:
            method = methods[i // 2 % len(methods)]
            result = exercise_frames(lab, path, method, frames)
        status, verdict = lab.verdict(result, form, path, method)
        if status not in (0, 5):  # 5: too sensitive
            accused += 1
            print('accused:', method, scene_name, form, status, verdict, sep='  ')
    return accused


def start_with_frames(lab, names, *options, report=None):
    """Starts check_frames with the same frame under several names. The report is appended to a file."""
    scene = PROJECT / 'data' / 'particle.txt'
    lab.count += 1
    folder = lab.folder / f'frames_{lab.count}'
    folder.mkdir()
    positions = ''.join(' '.join(line.split()[:2]) + '\n' for line in scene.read_text().splitlines()
                        if line and not line.startswith('#'))
    for name in names:
        (folder / name).write_text(positions)
    os.link(folder / name, folder / 'link')
    return subprocess.Popen([lab.check, folder, '--particles', scene, *options], stderr=subprocess.PIPE,
                            stdout=open(folder / report, 'a') if report else subprocess.PIPE, universal_newlines=True)


def garbage_is_not_equal(lab):
    """Whether right frames that end early, or in random numbers, are not accepted, and no mistake is named."""
    scene, path = lab.scene('random_masses')
    for damping in (1.0, 0.0):
        good = student.frames(scene, count=300, k_d=damping)
        junk = [lab.rng_array(frame.shape) for frame in good]
        cases = {
            'the start only': (good[:1], {5}), 'ten frames': (good[:10], {5}),
            'the first half': (good[:150], {5}), 'junk from frame 20 on': (good[:20] + junk[20:], {4}),
            'junk at the end': (good[:298] + junk[298:], {4} if damping else {4, 5}),
            'nan at the end': (good[:299] + [np.full_like(good[0], np.nan)], {4} if damping else {4, 5}),
            'huge numbers': ([np.full_like(good[0], 1e308)] * 300, {4}),
            'noise': ([frame * (1 + 1e-3 * noise) for frame, noise in zip(good, junk)], {4}),
            'g off by 1e-6': (student.frames(scene, count=300, k_d=damping, g=9.81 * (1 + 1e-6)), {4}),
            'right': (good, {0 if damping else 5}),  # without damping too sensitive for 30 s
        }
        for name, (frames, expected) in cases.items():
            status, verdict = lab.verdict(frames, '10g', path, 'Runge-Kutta-4', 300, '--damping', str(damping))
            if status not in expected or mistakes_in(verdict) or verdict.startswith('undecided') != (status == 5) or (
                    name == 'huge numbers' and ', by 1.4e+308 m' not in verdict):
                print('garbage:', name, damping, status, verdict)
                return False
    # Without damping: frames too late for some methods, far from the origin, more accurate than Auto, and a single one.
    late, _ = lab.verdict(good[290:], '6g', path, None, 300, '--damping', '0', first=290)
    np.savetxt(lab.folder / 'far.txt', scene + [20000, 0, 0], fmt='%.17g')
    far, _ = lab.verdict(np.add(good, [20000, 0]), '17g', lab.folder / 'far.txt', 'Runge-Kutta-4', 300, '--damping', '0')
    exact, _ = lab.verdict(student.frames(scene, count=100, k_d=0, h=0.001, steps=100), '8f', path, 'Auto', 100, '--damping', '0')
    _, alone = lab.verdict(good[30:31], '17g', path, 'Runge-Kutta-4', 31, first=30)
    # Programs in double that round to float what they print, one with a mistake.
    rounded, _ = lab.verdict([good[0], *np.float32(good[1:60]).astype(float)], '17g', path, 'Runge-Kutta-4', 60,
                             '--damping', '0', first=1)
    _, mistaken = lab.verdict(np.float32(student.frames(scene, count=60, g=9.8)).astype(float), '17g', path,
                              'Runge-Kutta-4')
    # Springs of 1 m: whether a length in integers is 0 or 1 m is a matter of rounding, which explains nothing.
    scene, path = lab.scene('particle')
    _, other = lab.verdict(student.frames(scene, 'Runge-Kutta-2', count=120, h=0.001, steps=25), '6g', path,
                           'Runge-Kutta-2', 120, '--time-step', '0.001', '--steps-per-frame', '20')
    # A level chain mirrored in y, with another sign of g, moves as without both.
    _, tiny = lab.verdict(student.frames(scene, count=100, g=9.8100004), '8f', path, 'Runge-Kutta-4')
    # Both programs end with nan, where numbers are too large.
    _, wrong_g = lab.verdict(student.frames(scene, 'Euler', count=200, h=0.05, k_d=0.0, g=9.80933008), '6g', path,
                             'Euler', None, '--time-step', '0.05', '--damping', '0')
    scene, path = lab.scene('horizontal_11')
    _, single = lab.verdict(student.frames(scene, 'Euler', ['single_precision'], 160, h=0.02), '9g', path, 'Euler', None,
                            '--time-step', '0.02')
    # Float errors of ten times as many steps could hide the wrong constant.
    scene, path = lab.scene('hanging_plucked')
    _, nearly = lab.verdict(student.frames(scene, count=100, k_d=0.99, wrong=['single_precision']), '9g', path, 'Runge-Kutta-4')
    # Between 8 and 16 m, every number with six decimals is the shortest text of a float.
    np.savetxt(lab.folder / 'high.txt', scene + [0, 12, 0], fmt='%.17g')
    _, high = lab.verdict(np.add(student.frames(scene, count=60, g=9.8066), [0, 12]), '6f', lab.folder / 'high.txt', 'Runge-Kutta-4')
    # Between 1 and 10 m, floats have at most eight digits.
    spring, _ = lab.verdict(student.frames(lab.scene('one_spring')[0]), 's', lab.scene('one_spring')[1], 'Runge-Kutta-4')
    named = [mistakes_in(report) for report in (alone, other, tiny, mistaken, wrong_g, single, nearly, high)]
    return (late, far, exact, rounded, spring) == (5, 5, 0, 0, 0) and named == [
        ['no_damping'], [], [], ['gravity_9.8'], ['g'], ['single_precision'], ['single_precision', 'k_d'], ['g']]


def other_courses_are_judged(lab):
    """Whether programs with air drag, with Heun or Ralston, and with implicit Euler are equal or their mistakes named."""
    scene, path = lab.scene('random_masses')
    heun, air, file = dict(tableau=student.HEUN), ('--air-drag', '0.2'), lab.folder / 'ralston.txt'
    implicit, ralston = dict(method='Backward-Euler'), dict(tableau=dict(start=[(), (2 / 3,)], weights=(1 / 4, 3 / 4)))
    single = wrong('single_precision')
    file.write_text('# Ralston\n2/3\n1/4 3/4\n')
    cases = [  # program, format, first index, asked, status, what is named
        (dict(heun, air=0.2), '6f', 0, ('Heun', *air), 0, []), (dict(heun, air=0.2), '17g', 1, ('Heun', *air), 0, []),
        (dict(ralston, steps=4, h=0.02), '6g', 0, ('Ralston', '--steps-per-frame', '4', '--time-step', '0.02'), 0, []),
        (ralston, '9g', 0, (file,), 0, []), (dict(heun, air=0.2), '8f', 0, ('Heun',), 4, ['air_drag']),
        (heun, '8f', 0, ('Heun', *air), 4, ['no_air_drag']),
        (dict(heun, air=0.2), '8f', 0, ('Runge-Kutta-2', *air), 4, ['heun']),
        (dict(heun, wrong=['gravity_divided']), '8f', 0, (file,), 4, ['heun', 'gravity_divided']),
        (implicit, '6f', 0, ('Backward-Euler',), 0, []),
        (dict(implicit, air=0.2), '8g', 1, ('Backward-Euler', *air), 0, []),
        (dict(implicit, k_s=40), '6f', 0, ('Backward-Euler',), 4, ['k_s']),
        (dict(implicit, wrong=['no_damping']), '6f', 0, ('Backward-Euler',), 4, ['no_damping']),
        (implicit, '6f', 0, ('Euler',), 4, 'Backward-Euler'), (dict(k_s=45), '6g', 0, ('Runge-Kutta-4',), 4, ['k_s']),
        (dict(L_0=0.9), '6g', 0, ('Runge-Kutta-4',), 4, ['L_0']), (dict(g=9), '7g', 0, ('Runge-Kutta-4',), 4, ['g']),
        (single, '9g', 1, ('Runge-Kutta-4',), 4, ['single_precision']),  # below: up to 1e38, then nan
        (dict(h=0.011), 's', 0, ('Runge-Kutta-4', '--time-step', '0.011'), 0, []),
        (dict(method='Euler', h=0.16), 's', 0, ('Euler', '--time-step', '0.16'), 5, []),  # explodes
        (single, 's', 1, ('Runge-Kutta-4',), 4, ['single_precision']), (dict(g=9.8, method='Euler'), 's', 0, ('Euler',), 4, ['gravity_9.8']),
        (dict(single, method='Euler', h=0.04), '6f', 0, ('Euler', '--time-step', '0.04'), 4, ['single_precision']),
        # Errors hardly larger than those of float, in double: nothing that has been tried.
        (dict(g=9.81 * (1 + 1e-6)), '9g', 0, ('Runge-Kutta-4',), 4, []),
        # The fewest mistakes first: Runge-Kutta-4 with two mistakes reproduces these frames, too.
        (dict(single, method='Runge-Kutta-2'), '8g', 0, (None,), 4, ['single_precision'])]
    good = True
    for program, form, first, (asked, *options), expected, names in cases:
        status, verdict = lab.verdict(student.frames(scene, count=40, **program), form, path, asked, 40, *options,
                                      first=first)
        is_named = f'frames of {names}:' in verdict if isinstance(names, str) else mistakes_in(verdict) == names
        if status != expected or not is_named or ('numbered' in verdict) != (first == 1):
            print('course:', program, form, first, asked, options, status, verdict)
            good = False
    return good


def start_may_be_a_copy(lab):
    """Whether frames are accepted whose start is the particle file, with more digits than the others."""
    scene, path = lab.scene('random')
    for first in (0, 1):
        lab.verdict(student.frames(scene, count=40), '6g', path, 'Runge-Kutta-4', first=first)
        folder = lab.folder / f'frames_{lab.count}'
        np.savetxt(folder / f'frame_000{first}.txt', scene[:, :2], fmt='%.17g')
        (folder / f'frame_00{20 + first}.txt').unlink()
        said = subprocess.run([lab.check, folder, '-p', path, '--frames', '40'], stdout=subprocess.PIPE, check=False)
        if said.returncode != 0 or b'note: 1 missing frame, the first is frame 2%d' % first not in said.stdout:
            return False
    return True


def resumed_run_is_equal(lab, method):
    """Whether the second half of a run is accepted, with the start or with the saved state as particle file."""
    start, state, folder = PROJECT / 'data' / 'random_masses.txt', lab.folder / 'state.txt', lab.folder / 'resumed'
    for words in ((start, '--frames', '51', '--save-state', state, '--no-frames'),
                  (state, '--frames', '101', '--resume', '--output', folder)):
        subprocess.run([lab.exercise, method, *words], stdout=subprocess.DEVNULL, check=True)
    runs = [subprocess.run([lab.check, folder, '--method', method, '--frames', '101', *words], check=False,
                           capture_output=True, text=True)
            for words in (('--particles', start), ('--particles', state, '--resume'))]
    return all(run.returncode == 0 and (' within 1e-06 m:' in run.stdout) == (method == 'Auto') for run in runs)


def stops_inside_a_frame(lab):
    """Whether a signal ends a frame that would take days."""
    for method, *interval in (('Runge-Kutta-4', '--steps-per-frame', '2000000000'),
                              ('Taylor-8', '--frame-interval', '1e6')):
        process = start_with_frames(lab, ['frame_0000.txt', 'frame_0001.txt'], '--method', method, *interval)
        try:
            process.communicate(timeout=1)
            return False
        except subprocess.TimeoutExpired:
            process.terminate()
        output, errors = process.communicate()
        if (process.returncode, output, errors.count('\n')) != (143, '', 1):
            print('signal:', method, process.returncode, output, errors)
            return False
    return True


def misuse_is_refused(lab):
    """Whether options that would be ignored are refused by name."""
    file = lab.folder / 'Heun'  # the name of a method
    file.write_text('1\n1/2 1/2\n')
    cases = [(('--tableau', file, '--tolerance', '1e-3'), 2, '--tolerance: tableau Heun takes fixed steps', None),
             (('--frames', '4', '--frames', '5'), 2, '--frames: is given twice', None), (('--frames', '1'), 0, '', 'report.txt'),
             (('--tableau', file, '--frames', '1'), 0, '', None), (('--frames', '1', 'a\nb  equal'), 1, '', None),
             *((('--frames', '1'), 2, 'standard output: is an input of this run', name) for name in ('frame_0.txt', 'link'))]
    for options, status, message, report in cases:
        process = start_with_frames(lab, ['frame_0.txt'], *options, report=report)
        rows, errors = process.communicate()
        if (process.returncode != status or not errors.startswith(message) or errors.count('\n') != bool(message)
                or (rows or '').count('\n') > 2):
            print('misuse:', options, process.returncode, errors)
            return False
    return True


def main(check, exercise, frames=60, seed=1, number_wrong=40, number_right=40):
    with tempfile.TemporaryDirectory() as folder:
        lab = Lab(pathlib.Path(folder), (check, exercise), int(seed))
        endless = start_with_frames(lab, ['frame_0000.txt', 'frame_0001.txt'], '--method', 'Euler',
                                    '--steps-per-frame', '2000000000')
        named_rightly = try_wrong(lab, int(frames), int(number_wrong))
        accused = try_right(lab, int(frames), int(number_right))
        assert garbage_is_not_equal(lab)
        assert other_courses_are_judged(lab)
        assert resumed_run_is_equal(lab, 'Runge-Kutta-4') and resumed_run_is_equal(lab, 'Auto')
        assert start_may_be_a_copy(lab) and stops_inside_a_frame(lab)
        assert misuse_is_refused(lab)
        assert 'it takes too long' in endless.communicate()[0] and endless.returncode == 5
    print(f'{named_rightly} of {number_wrong} wrong programs named, {accused} of {number_right} right ones accused')
    # Measured: 40 and 0 with these defaults.
    return 0 if named_rightly >= 0.95 * int(number_wrong) and accused == 0 else 1


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))

"""Programs with failing system calls; see ../support/fault_injection.cpp."""
import os
import signal
from pathlib import Path

from pendulum_process import SCENE, Folder, case, files_in

INJECTION = os.environ['FAULT_INJECTION']
CLEANS_UP = {'unlinkat', 'fstatat', 'fstat'}  # calls that remove the unfinished file


def fill(folder, **files):
    """Writes the particle file and others with this content."""
    for name, content in dict(files, particle_txt=Path(SCENE).read_bytes()).items():
        Path(folder, name.replace('_', '.')).write_bytes(content)


def injection(folder, report, call, kind):
    return {'LD_PRELOAD': INJECTION, 'FAULT_FOLDER': folder, 'FAULT_CALL': str(call), 'FAULT_KIND': kind,
            'FAULT_REPORT': report}


def disturbed_runs(test, kind, run, files):
    """Runs a program with a fault of this kind in a folder with files. Of each series of equal calls, the first, the
    last and one in the middle are disturbed. Yields the call, what run(folder, environment) returns, and the folder."""
    with Folder() as outside, Folder() as folder:
        fill(folder, **files)
        run(folder, injection(folder, outside + '/calls', 0, 'list'))
        names = [''] + Path(outside, 'calls').read_text().split('\n')
    begins = [k for k in range(1, len(names)) if names[k] != names[k - 1]]
    calls = sorted({call for first, end in zip(begins, begins[1:]) for call in (first, (first + end - 1) // 2, end - 1)})
    test.assertGreater(len(calls), 10)
    for call in calls:
        with Folder() as outside, Folder() as folder:
            fill(folder, **files)
            result = run(folder, injection(folder, outside + '/call', call, kind))
            name = ''
            if os.path.exists(outside + '/call'):  # a program with threads does not always make as many
                name = Path(outside, 'call').read_text()
            if name:
                yield name, result, folder


def check_faults(test, kinds, run, message, files, repeats=True):
    """Whatever fails, files are those of before or of a complete run, and the program says so in one line.
    :param run: run(folder, environment) returns the exit status and the output
    :param message: pattern of the output of a failed run
    :param files: those in the folder before, apart from the particle file
    :param repeats: whether a run after a kill gives the same files"""
    with Folder() as folder:
        fill(folder, **files)
        test.assertEqual(run(folder)[0], 0)
        finished = files_in(folder)
    earlier = {name.replace('_', '.'): text for name, text in files.items()}
    for kind in kinds:
        for name, (status, output), folder in disturbed_runs(test, kind, run, files):
            with case(kind=kind, name=name, output=output):
                found = files_in(folder)
                for file in finished:
                    if file in earlier or file in found:
                        test.assertIn(found[file], (earlier.get(file), finished[file]), file)
                if kind == 'kill':
                    test.assertEqual(status, -signal.SIGKILL)
                    test.assertEqual(run(folder)[0], 0)  # as if nothing had happened
                    if repeats:
                        test.assertEqual(files_in(folder), finished)
                elif status == 0:
                    test.assertEqual({**finished, **found}, found)
                else:
                    test.assertEqual(status, 1)
                    test.assertRegex(output, message)
                    if kind == 'fail' and name not in CLEANS_UP:
                        test.assertLessEqual(set(found), set(finished), 'unfinished files')

"""Programs with failing system calls; see ../support/fault_injection.cpp."""
import os

from pendulum_process import project

SCENE = project('data/particle.txt')
INJECTION = os.environ['FAULT_INJECTION']
NO_MASTER = {'ROS_MASTER_URI': 'http://127.0.0.1:1'}
CLEANS_UP = {'unlinkat', 'fstatat', 'fstat'}  # calls that remove the unfinished file


def files_in(folder):
    files = {}
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), 'rb') as file:
            files[name] = file.read()
    return files


def injection(folder, report, call, kind):
    return {'LD_PRELOAD': INJECTION, 'FAULT_FOLDER': folder, 'FAULT_CALL': str(call),
            'FAULT_KIND': kind, 'FAULT_REPORT': report}


def read_report(report):
    if not os.path.exists(report):
        return ''
    with open(report) as file:
        name = file.read()
    os.remove(report)
    return name


def fill(folder, bag=b'earlier bag'):
    with open(SCENE, 'rb') as scene, open(folder + '/particle.txt', 'wb') as particles:
        particles.write(scene.read())
    if bag:
        with open(folder + '/run.bag', 'wb') as file:
            file.write(bag)

"""The look of a method in all pictures of this package: a colour and a line style of its own.

Only the page colours runs instead, because it shows several of one method. Related methods share a colour.
"""
METHODS = {
    'Euler': ('#c1440e', '-'), 'Semi-Implicit-Euler': ('#c1440e', '--'), 'Backward-Euler': ('#c1440e', ':'),
    'Runge-Kutta-2': ('#b8860b', '-'), 'Velocity-Verlet': ('#b8860b', '--'),
    'Runge-Kutta-4': ('#1f5fa8', '-'), 'Dormand-Prince-5': ('#1f5fa8', '--'),
    'Taylor-8': ('#0f8f8f', '-'), 'Taylor-12': ('#0f8f8f', '--'),
    'Stabilized-Taylor-4': ('#8f5fc4', '--'), 'Stabilized-Taylor-8': ('#8f5fc4', '-'),
    'Radau-9': ('#8a8a8a', '-'), 'Auto': ('#111111', '-')}

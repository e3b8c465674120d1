"""Pictures of tables show all of their rows, and every picture shows a method alike."""
import argparse
import itertools
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from support import DATA

import spring_pendulum as sp

PROJECT = DATA.parent
sys.path.insert(0, str(PROJECT / 'scripts'))
import plot_table  # noqa: E402
from method_styles import METHODS  # noqa: E402

VERDICTS = ['ok', 'drift', 'diverged', 'sensitive']


def draw(text, **options):
    with tempfile.NamedTemporaryFile('w', suffix='.csv') as file:
        file.write(text)
        file.flush()
        defaults = dict.fromkeys(('x', 'y', 'color', 'lines', 'panels', 'limit', 'title', 'log'), '')
        figure = plot_table.draw(plot_table.Table(file.name), argparse.Namespace(**{**defaults, **options}))
    figure.canvas.draw()
    return figure


def legend(figure):
    return [text.get_text() for text in (figure.legends or [figure.axes[0].get_legend()])[0].get_texts()]


class Maps(unittest.TestCase):
    TABLE = 'case,method,mass [kg],time_step [s],verdict,tip_x [m]\n' + ''.join(
        '%d,%s,%s,%s,%s,%s\n' % (k, method, mass, step, VERDICTS[k % 4 if method == 'Euler' else 0], k)
        for k, (method, mass, step) in enumerate(itertools.product(('Auto', 'Euler'), (1, 2), (0.1, 0.2, 0.4))))

    def test_have_a_complete_legend_and_panels_with_name_and_unit(self):
        figure = draw(self.TABLE, type='map', x='mass', y='time_step', color='verdict', panels='method')
        self.assertEqual([axes.get_title() for axes in figure.axes if axes.get_visible()], ['Auto', 'Euler'])
        self.assertLessEqual(set(VERDICTS), set(legend(figure)))
        figure = draw(self.TABLE, type='lines', x='time_step', y='tip_x', lines='method', panels='mass')
        self.assertEqual([axes.get_title() for axes in figure.axes], ['mass = 1 kg', 'mass = 2 kg'])
        self.assertEqual(legend(figure), ['Auto', 'Euler'])
        self.assertRaises(SystemExit, draw, self.TABLE, type='map', x='method', y='time_step', color='verdict')

    def test_show_a_number(self):
        figure = draw(self.TABLE, type='map', x='mass', y='time_step', color='tip_x', panels='method', log='y')
        shown = [axes.collections[0].get_array().ravel().tolist() for axes in figure.axes[:2]]
        self.assertEqual(shown, [[0, 3, 1, 4, 2, 5], [6, 9, 7, 10, 8, 11]])
        self.assertEqual({axes.get_ylabel() for axes in figure.axes[2:]}, {'tip_x [m]'})

    def test_show_the_limit_nearest_to_a_row_of_a_place(self):
        table = 'case,x,y,limit,error\n0,1,1,9,1\n1,1,4,5,1\n2,1,8,2,1\n3,2,1,9,1\n4,2,4,9,1\n5,2,8,9,1\n'
        axes = draw(table, type='map', x='x', y='y', color='error', limit='limit').axes[0]
        self.assertEqual([list(numbers) for numbers in axes.lines[0].get_data()], [[1, 2], [5, 9]])


class Lines(unittest.TestCase):
    def test_of_all_methods_look_different_and_diverged_rows_are_left_out(self):
        names = [method.name for method in sp.methods() if method.name in METHODS]
        self.assertEqual(names, [method.name for method in sp.methods()])
        figure = draw('case,method,x [m],y [s],verdict\n' + ''.join(
            '0,%s,%s,%s,%s\n' % (name, x, y * k, verdict) for k, name in enumerate(names)
            for x, y, verdict in ((1, 1, 'ok'), (2, 2, 'ok'), (3, math.nan, 'diverged'))), type='lines', x='x', y='y', lines='method')
        lines = figure.axes[0].lines
        self.assertEqual(legend(figure), names)
        self.assertEqual(len({(line.get_color(), line.get_linestyle()) for line in lines}), len(names))
        self.assertEqual({tuple(line.get_xdata()) for line in lines}, {(1.0, 2.0)})

    def test_show_all_positive_points_on_logarithmic_axes(self):
        table = 'case,p,x,y\n0,a,1,10\n1,a,2,20\n2,b,-1,0\n3,b,3,0.1\n'
        axes = draw(table, type='lines', x='x', y='y', panels='p', log='xy').axes[1]
        self.assertTrue(axes.get_xlim()[0] < 1 < 3 < axes.get_xlim()[1] and axes.get_ylim()[0] < 0.1 < 20 < axes.get_ylim()[1])

    def test_show_median_and_range_of_several_rows(self):
        figure = draw('case,x,y\n0,1,5\n1,1,nan\n2,1,1\n3,1,2\n4,2,7\n', type='lines', x='x', y='y')
        self.assertEqual(figure.axes[0].lines[0].get_ydata().tolist(), [2, 7])
        low, high = figure.axes[0].collections[0].get_paths()[0].get_extents().intervaly
        self.assertEqual((low, high), (1, 7))


class Histograms(unittest.TestCase):
    def test_count_what_did_not_diverge(self):
        rows = '0,3,ok\n\n1,1,ok\n2,2,ok\n3,10,ok\n4,nan,diverged\n'
        figure = draw('case,error,verdict\n%s' % rows, type='histogram', x='error')
        self.assertEqual(legend(figure), ['4 of 5 cases, median 2.5, 95 % at most 10'])
        bars = draw('case,x\n0,7e-6\n1,7e-6\n', type='histogram', x='x', log='x').axes[0].patches
        self.assertEqual([sum(bar.get_height() for bar in bars), bars[-1].get_height()], [2, 0])


class Tables(unittest.TestCase):
    def test_that_cannot_be_drawn_are_refused_in_one_line(self):
        for text, reason in ((b'', 'the table has no rows'), (b'case,x,y\n', 'the table has no rows'),
                             (b'png', 'the name of the picture must end in .png'),
                             (b'case,x,y,y\n0,1,1,1\n', 'two columns have the same name'),
                             (b'case,x,y\n\xff,1,1\n', "can't decode byte"), (None, 'No such file or directory'),
                             (b'case,x,y\n0,1,1e308\n1,1,-1e308\n', 'cannot draw'),
                             (b'case,x,y\n0,2,1\n1,0,1\n', 'x = 0 cannot be on a logarithmic axis'),
                             (b'self', 'a.png: is the table')):
            with tempfile.TemporaryDirectory() as folder:
                name = 'a.png' if text == b'self' else 'a.csv'
                if text is not None:
                    pathlib.Path(folder, name).write_bytes(text)
                arguments = '%s a.%s --type map --x x --y y --color y --log x' % (name, 'csv' if text == b'png' else 'png')
                done = subprocess.run([plot_table.__file__, *arguments.split()], cwd=folder, capture_output=True, text=True)
            self.assertRegex(done.stderr, r'^plot: .*%s.*\n$' % reason)
            self.assertEqual(done.returncode, 2 if text is not None else 1)

    def test_show_dollars_as_they_are(self):
        figure = draw('case,a,$y_{$\n0,$x_{$,1\n', type='lines', x='$y_{$', y='$y_{$', lines='a')
        self.assertEqual(legend(figure), [r'a = \$x_{\$'])


class Pictures(unittest.TestCase):
    def test_use_one_palette(self):
        pairs = []
        for path in ('examples/python/compare_methods.py', 'examples/python/work_precision.py'):
            pairs += re.findall(r"'([\w-]+)': \(?'(#\w+)'", (PROJECT / path).read_text())
        names, colors = (re.search('%s = "(.*)"' % key, (PROJECT / 'docs/plots/compare.plt').read_text()).group(1).split()
                         for key in ('methods', 'colors'))
        pairs += zip(names, colors)
        self.assertEqual(len(pairs), 11)
        for method, color in pairs:
            self.assertEqual(color, METHODS[method][0], method)

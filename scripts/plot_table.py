#!/usr/bin/python3 -B
"""Draws the table of a sweep as a PNG: plot_table.py TABLE.csv PICTURE.png --type lines --x KEY --y KEY ...

sweep --plot calls it with the options of the study's entry `plot`; docs/sweep.md explains them. It can also
draw an existing table again. With --try, it only finds out whether it could; the table may lack columns.
"""
import signal
if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C is no reason for a traceback
signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])

import argparse
import contextlib
import csv
import itertools
import math
import os
import statistics
import sys
import warnings

from method_styles import METHODS

os.environ['MPLBACKEND'] = 'Agg'
try:
    import matplotlib
    from matplotlib import pyplot
    from matplotlib.colors import LogNorm, Normalize
except ImportError:
    sys.exit('--plot: needs matplotlib for /usr/bin/python3 (Debian: python3-matplotlib)')

# Colours that people with any colour vision can tell apart (M. Okabe, K. Ito, 2008), for everything else.
COLORS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9']
STYLES = [(color, style) for style, color in itertools.product(['-', '--', ':'], COLORS)]
MARKERS = 'osD^vPX'
# From harmless to bad.
VERDICTS = {'ok': '#c6dbef', 'not checked': '#d9d9d9', 'sensitive': '#74c476', 'inaccurate': '#9e9ac8',
            'drift': '#fee391', 'gained energy': '#f98e1b', 'diverged': '#662506'}


def refuse(what, status=2):
    print('plot: ' + what, file=sys.stderr)
    sys.exit(status)


def plain(text):
    """A text for matplotlib, which would read a formula between two dollars."""
    return text.replace('$', r'\$')


def number(text):
    try:
        return float(text)
    except ValueError:
        refuse("only numbers can be drawn, got '%s'" % text)


class Table:
    """The rows of a table as dictionaries; a key is the title of a column without its unit."""

    def __init__(self, path):
        with open(path, newline='', encoding='utf-8') as file:
            titles, *rows = [*filter(None, csv.reader(file))] or [[]]
        self.titles = {title.split(' [')[0]: title for title in titles}
        if not rows:
            refuse(path + ': the table has no rows')
        if len(self.titles) < len(titles):
            refuse(path + ': two columns have the same name')
        self.rows = [dict(itertools.zip_longest(self.titles, row, fillvalue='nan')) for row in rows]

    def values(self, key):
        """The different values of a key in the order of the table; one None without a key."""
        return list(dict.fromkeys(row[key] for row in self.rows)) if key else [None]

    def title(self, key):
        return plain(self.titles[key])

    def label(self, key, value):
        if value is None:
            return ''
        unit = self.titles[key][len(key):].strip(' []')
        return plain(value if key == 'method' else ('%s = %s %s' % (key, value, unit)).strip())


def draw_lines(axes, rows, table, options):
    for k, line in enumerate(table.values(options.lines)):
        points = {}
        for row in rows:
            place, y = number(row[options.x]), number(row[options.y])
            if (line is None or row[options.lines] == line) and math.isfinite(y):
                points.setdefault(place, []).append(y)
        color, style = METHODS.get(line) or STYLES[k % len(STYLES)]
        x = sorted(v for v in points if math.isfinite(v))
        middle = [statistics.median(points[v]) for v in x]
        axes.plot(x, middle, style, color=color, marker=MARKERS[k % len(MARKERS)], markersize=3.5,
                  label=table.label(options.lines, line))
        if any(len(points[v]) > 1 for v in x):  # several rows at one place: their range around the median
            axes.fill_between(x, [min(points[v]) for v in x], [max(points[v]) for v in x], color=color, alpha=0.2)


def borders(key, values, logarithmic):
    """The borders of the cells around sorted values."""
    if logarithmic and values[0] <= 0:
        refuse('%s = %g cannot be on a logarithmic axis; leave out log or this value' % (key, values[0]))
    at = [math.log10(v) if logarithmic else v for v in values]
    if len(at) == 1:
        inner = [at[0] - 0.25, at[0] + 0.25]
    else:
        inner = [(a + b) / 2 for a, b in zip(at, at[1:])]
        inner = [2 * at[0] - inner[0], *inner, 2 * at[-1] - inner[-1]]
    return [10 ** v if logarithmic else v for v in inner]


def draw_map(axes, rows, table, options):
    x = sorted({row[options.x] for row in rows}, key=number)
    y = sorted({row[options.y] for row in rows}, key=number)
    if not all(math.isfinite(number(value)) for value in x + y):
        refuse('x and y of a map must be axes of numbers')
    verdicts = list(VERDICTS)
    cells = [[math.nan] * len(x) for _ in y]
    drawn = set()
    for row in rows:
        place = row[options.x], row[options.y]
        if place in drawn:
            refuse('several rows have %s = %s and %s = %s; draw them in panels or leave some out'
                   % (options.x, place[0], options.y, place[1]))
        drawn.add(place)
        value = row[options.color]
        cells[y.index(place[1])][x.index(place[0])] = (
            verdicts.index(value) if value in verdicts else number(value))
    places = [borders(key, [number(value) for value in values], letter in options.log)
              for letter, key, values in (('x', options.x, x), ('y', options.y, y))]
    if options.color == 'verdict':
        colors = matplotlib.colors.ListedColormap(list(VERDICTS.values()))
        axes.pcolormesh(*places, cells, cmap=colors, vmin=-0.5, vmax=len(verdicts) - 0.5)
        for verdict, color in VERDICTS.items():
            axes.plot([], [], 's', color=color, label=verdict)
    else:
        shown = [v for line in cells for v in line if math.isfinite(v)] or [0.0, 1.0]
        scale = LogNorm if min(shown) > 0 and max(shown) > 100 * min(shown) else Normalize
        mesh = axes.pcolormesh(*places, cells, cmap='viridis', norm=scale(min(shown), max(shown)))
        axes.figure.colorbar(mesh, ax=axes, label=table.title(options.color))
    if options.limit:
        limits = {}  # by x: that of the row which is nearest to its limit, since limits may depend on y
        for row in rows:
            place, limit = number(row[options.x]), number(row[options.limit])
            distance = abs(number(row[options.y]) - limit)
            if distance < limits.get(place, (math.inf, 0))[0]:
                limits[place] = distance, limit
        points = sorted((place, limit) for place, (_, limit) in limits.items())
        axes.plot(*zip(*points) if points else ([], []), 'k-', linewidth=2, label=table.title(options.limit))
        axes.set_ylim(places[1][0], places[1][-1])


def drawn_numbers(rows, options):
    return sorted(v for v in (number(row[options.x]) for row in rows)
                  if math.isfinite(v) and (v > 0 or 'x' not in options.log))


def draw_histogram(axes, rows, table, options):
    values = drawn_numbers(rows, options)
    if not values:
        return
    everything = drawn_numbers(table.rows, options)  # all panels have the same bars
    first, last = everything[0], everything[-1]
    to, back = (math.log, math.exp) if 'x' in options.log else (float, float)
    low, high = to(first), to(last)
    if low == high:
        low, high = low - 0.5, high + 0.5
    bins = [back(low + (high - low) * k / 30) for k in range(31)]
    bins[0], bins[-1] = min(first, bins[0]), max(last, bins[-1])  # without rounding errors
    # The smallest value with at least 95 % of all values at or below it.
    most = values[math.ceil(0.95 * len(values)) - 1]
    axes.hist(values, bins=bins, color=COLORS[0], label='%d of %d cases, median %.3g, 95 %% at most %.3g'
              % (len(values), len(rows), statistics.median(values), most))


def fit_logarithmic_axes(axes, table, options):
    """Shows every positive point. If a panel has other points, matplotlib would fit the common axes to it alone."""
    points = [(number(row[options.x]), number(row[options.y])) for row in table.rows]
    for letter, values in zip('xy', zip(*(point for point in points if all(map(math.isfinite, point))))):
        powers = [math.log10(value) for value in values if value > 0]
        # Beyond 1e280, matplotlib cannot draw given limits.
        if letter in options.log and 0 < len(powers) < len(values) and max(map(abs, powers)) < 280:
            margin = 0.05 * (max(powers) - min(powers)) or 0.1
            axes.set(**{letter + 'lim': (10 ** (min(powers) - margin), 10 ** (max(powers) + margin))})


def draw(table, options):
    panels = table.values(options.panels)
    for key, most in (('panels', 100), ('lines', 40)):
        count = len(table.values(getattr(options, key)))
        if count > most:
            refuse('%s: %s has %d values, and at most %d can be drawn' % (key, getattr(options, key), count, most))
    columns = min(len(panels), 4)
    lines = -(-len(panels) // columns)
    size = (8, 5.5) if len(panels) == 1 else (4.2 * columns, 4.0 * lines + 1)
    figure, grid = pyplot.subplots(lines, columns, figsize=size, squeeze=False, sharex=True, sharey=True)
    for axes in grid.flat[len(panels):]:
        axes.set_visible(False)
    for axes in grid.flat[:len(panels)][-columns:]:  # the lowest of each column
        axes.tick_params(labelbottom=True)
    legend = {}
    for axes, panel in zip(grid.flat, panels):
        rows = [row for row in table.rows if panel is None or row[options.panels] == panel]
        if 'x' in options.log:
            axes.set_xscale('log')
        if 'y' in options.log:
            axes.set_yscale('log')
        {'lines': draw_lines, 'map': draw_map, 'histogram': draw_histogram}[options.type](axes, rows, table, options)
        axes.set(xlabel=table.title(options.x), ylabel=table.title(options.y) if options.y else 'cases',
                 title=table.label(options.panels, panel))
        entries = [(label, handle) for handle, label in zip(*axes.get_legend_handles_labels()) if label]
        if options.type != 'histogram':
            legend.update(entries)
        elif entries:  # the numbers of this panel
            axes.legend(loc='lower center', bbox_to_anchor=(0.5, 1.1 if options.panels else 1.0), fontsize=7)
    if options.type == 'lines':
        fit_logarithmic_axes(grid[0][0], table, options)
    figure.suptitle(plain(options.title))
    height = 0.0
    if legend:
        columns = max(1, min(4, int(size[0] / (0.5 + 0.07 * max(map(len, legend))))))
        height = 0.12 + 0.16 * -(-len(legend) // columns)
        figure.set_figheight(size[1] + max(0.0, height - 1.0))
        height /= figure.get_figheight()
        figure.legend(legend.values(), legend.keys(), loc='lower center', ncol=columns, fontsize=8)
    figure.tight_layout(rect=(0, height, 1, 1))
    return figure


def save(figure, picture):
    # Whole or absent, as all outputs, and where a link leads to.
    picture = os.path.realpath(picture)
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGHUP, signal.SIGINT, signal.SIGTERM])  # until this program ends
    unfinished = os.path.join(os.path.dirname(picture), '.plot.%s.tmp' % os.urandom(8).hex())
    try:
        try:
            with open(unfinished, 'xb') as file:
                figure.savefig(file, format='png', dpi=100)
            os.replace(unfinished, picture)
        except BaseException:
            with contextlib.suppress(FileNotFoundError):
                os.remove(unfinished)
            raise
    except OSError as error:
        sys.exit('%s: could not be drawn: %s' % (picture, error.strerror))


def draw_table(options):
    table = Table(options.table)
    for key in {'lines': ['x', 'y'], 'map': ['x', 'y', 'color'], 'histogram': ['x']}[options.type]:
        if not getattr(options, key):
            refuse('%s needs %s' % (options.type, key))
    unused = {'lines': 'color limit', 'map': 'lines', 'histogram': 'y color lines limit'}[options.type].split()
    for key in unused:
        if getattr(options, key):
            refuse('%s: a %s does not use it' % (key, {'lines': 'plot of lines'}.get(options.type, options.type)))
    if options.type == 'histogram' and 'y' in options.log:
        refuse('log: a histogram has x only')
    for key in ('x', 'y', 'color', 'lines', 'panels', 'limit'):
        if getattr(options, key) not in ('', *table.titles):
            refuse("%s: unknown axis or column '%s'; known are %s"
                   % (key, getattr(options, key), ', '.join(list(table.titles)[1:])))
    if options.limit and table.titles[options.limit][len(options.limit):] != table.titles[options.y][len(options.y):]:
        refuse('limit: %s has another unit than %s' % (table.titles[options.limit], table.titles[options.y]))
    if options.only_try and 'verdict' in table.titles:  # all columns may be nan, but no verdict is a number
        for row in table.rows:
            row['verdict'] = 'ok'
    figure = draw(table, options)
    if not options.only_try:
        save(figure, options.picture)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        refuse(message)


def main():
    parser = Parser(description=__doc__)
    parser.add_argument('table')
    parser.add_argument('picture')
    parser.add_argument('--try', dest='only_try', action='store_true', help='write nothing')
    parser.add_argument('--type', choices=['lines', 'map', 'histogram'], required=True)
    for key in ('x', 'y', 'color', 'lines', 'panels', 'limit', 'title'):
        parser.add_argument('--' + key, default='')
    parser.add_argument('--log', choices=['x', 'y', 'xy'], default='')
    options = parser.parse_args()
    if not options.picture.endswith('.png'):
        refuse("the name of the picture must end in .png, got '%s'" % options.picture)
    if os.path.exists(options.picture) and not (os.path.isfile(options.picture) and os.access(options.picture, os.W_OK)):
        refuse('%s: is no regular file, or one without write permission' % options.picture, 1)
    if os.path.exists(options.table) and os.path.exists(options.picture) and os.path.samefile(options.table, options.picture):
        refuse('%s: is the table' % options.picture)
    warnings.simplefilter('ignore')  # of matplotlib, about what a picture cannot show
    try:
        draw_table(options)
    except Exception as error:  # A table may have any text in it, and matplotlib fails on numbers in many ways.
        reason = getattr(error, 'strerror', None) or str(error) or type(error).__name__
        refuse('cannot draw %s: %s' % (options.table, ' '.join(reason.split())), 1 if isinstance(error, OSError) else 2)


if __name__ == '__main__':
    main()

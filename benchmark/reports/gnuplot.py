"""Line plots through gnuplot, in the one style of all benchmark plots: this package in strong lines, peers
in thin dashed ones, what failed as a cross at the top edge, the legend outside."""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from method_styles import METHODS  # noqa: E402

DASHES = {"-": "1", "--": "(14,5)", ":": "(3,5)"}
LIBRARY_COLORS = {
    "plain": ("#8a8a8a", "#333333"),
    "Boost.odeint": ("#9ecbf0", "#5aa2dc", "#1f6fb2", "#0b4a80", "#3b3fb0"),
    "GSL": ("#c9a6ea", "#8f5fc4", "#5a2d91"),
    "SUNDIALS": ("#a8d8a0", "#6dbb6a", "#3f9b58", "#1c7a4a", "#0d5c3c", "#7f9c2f"),
    "MuJoCo": ("#c77d2e",),
    "Simbody": ("#c2578f",),
    "SciPy": ("#0f8f8f",)}
POINT_TYPES = (7, 5, 9, 11, 13, 4, 6, 8, 10, 12)


def style_of(library, number, method="Runge-Kutta-4"):
    """gnuplot's words for the line of a method: its number counts within its library."""
    point = f"pt {POINT_TYPES[number % len(POINT_TYPES)]}"
    if library == "own":
        color, line = METHODS[method]
        return f"dt {DASHES[line]} lw 2.6 ps 0.9 {point} lc rgb '{color}'"
    colors = LIBRARY_COLORS[library]
    return f"dt (10,6) lw 1.5 ps 0.8 {point} lc rgb '{colors[number % len(colors)]}'"


class Plot:
    """A log-log plot of lines with points."""

    def __init__(self, title, x_label, y_label, x_range, y_range):
        self.lines = []
        self.data = []
        self.settings = [
            f'set title "{title}" font ",15"', f'set xlabel "{x_label}"',
            f'set ylabel "{y_label}"', "set logscale xy",
            f"set xrange [{x_range[0]}:{x_range[1]}]", f"set yrange [{y_range[0]}:{y_range[1]}]",
            "set format '10^{%L}'", "set mxtics 10", "set mytics 10",
            "set grid xtics ytics lc rgb '#dddddd' lt 1", "set border 3 lc rgb '#444444'",
            "set tics nomirror", "set key outside right top Left reverse spacing 1.15 samplen 4 noenhanced"]
        self.top = 0.9 * y_range[1]

    def line(self, points, title, style):
        name = self._block(points or [("NaN", "NaN")])
        self.lines.append(f'{name} using 1:2 with linespoints {style} title "{title}"')

    def crosses(self, places, style, title=""):
        """Crosses at the top edge, for what has no place in the plot."""
        name = self._block([(x, self.top) for x in places])
        color = style[style.index("lc "):]
        shown = f'title "{title}"' if title else "notitle"
        self.lines.append(f"{name} using 1:2 with points pt 2 ps 1.6 lw 2.2 {color} {shown}")

    def write(self, path):
        """PATH.png"""
        script = "\n".join(self.data + self.settings)
        text = f"set terminal pngcairo size 1500,900 font 'DejaVu Sans,12'\nset output '{path}.png'\n" \
               f"{script}\nset clip one\nplot {', '.join(self.lines)}\n"
        subprocess.run(["gnuplot"], input=text, text=True, check=True)

    def _block(self, points):
        name = f"$data{len(self.data)}"
        rows = "\n".join(f"{x} {y}" for x, y in points)
        self.data.append(f"{name} << EOD\n{rows}\nEOD")
        return name

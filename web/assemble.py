#!/usr/bin/python3
"""Puts the page, its scripts and the library into one HTML file.

    assemble.py BUILD_FOLDER PAGE     BUILD_FOLDER has lab.js and lab.wasm of emscripten
"""
import base64
import json
import re
import subprocess
import sys
from pathlib import Path

WEB = Path(__file__).resolve().parent
LIBRARIES = Path('/usr/share/javascript')


def minified(path, *options):
    command = ['esbuild', str(path), '--minify', '--charset=utf8', '--log-level=error', *options]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main(build, page):
    scenes = {path.name: path.read_text() for path in sorted((WEB.parent / 'data').glob('*.txt'))}
    parts = {
        'style': (WEB / 'style.css').read_text(),
        'chart': (LIBRARIES / 'chart.js/chart.min.js').read_text(),
        'katex': (LIBRARIES / 'katex/katex.min.js').read_text(),
        'scenes': json.dumps(scenes),
        'library-js': minified(build / 'lab.js'),
        'library-worker': minified(WEB / 'worker.js'),
        'library-wasm': base64.b64encode((build / 'lab.wasm').read_bytes()).decode(),
        'app': minified(WEB / 'app.js', '--bundle', '--target=es2022'),
    }
    text = (WEB / 'page.html').read_text()
    for name, part in parts.items():
        if name != 'style':
            part = re.sub(r'</(?=script)', r'<\\/', part, flags=re.IGNORECASE)
        text = text.replace('{{' + name + '}}', part)
    unfinished = page.with_suffix('.unfinished')
    unfinished.write_text(text)
    unfinished.replace(page)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))

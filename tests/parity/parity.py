"""POV-Ray's samples rendered by retex, against POV-Ray's own depth, albedo and normals, and its time.

parity.py BUILD OUT LIST [SCENE...]: LIST is tests/long/examples.txt. OUT keeps POV-Ray's pictures and results, so that a
stopped run continues; results are made anew when the renderer is newer. Without names of scenes, a table of all is
written to OUT/parity.md and .csv. OUT/sheet.html has pictures.
PARITY_TIMES=again: measure POV-Ray's time again, in turn with ours."""
import concurrent.futures, csv, html, json, os, re, sys
import numpy as np
import reference as pov

CLOSE = 0.01            # depths may differ by this share
ANGLE = np.cos(np.radians(5))
ENOUGH = 0.99           # a scene whose share of equal depths is less is a miss
THREADS = 2


def options_of(words):
    """'-D clock=1 -D frame_number=1' as a dictionary."""
    return dict(word.split('=', 1) for word in words if '=' in word)


def albedo_difference(ours, pigment, layers):
    """POV-Ray shows of layers the bottom one (pigment), or what they shine with together (layers), which of a transparent
    surface is its pigment, darker. So where the two have different colours there are layers; else the nearer one counts."""
    share = (layers * pigment).sum(axis=2) / np.maximum((pigment * pigment).sum(axis=2), 1e-9)
    layered = np.abs(layers - share[:, :, None] * pigment).max(axis=2) > 0.01 + 0.02 * layers.max(axis=2)
    off = lambda theirs: np.abs(pov.srgb(ours) - pov.srgb(theirs)).mean(axis=2)
    return np.where(layered, off(layers), np.minimum(off(layers), off(pigment)))


class Scene:
    def __init__(self, build, out, name, options):
        self.name, self.options = name, options
        self.program = os.path.join(build, 'bin/retex-render')
        self.reference = pov.Reference(out, name, options)
        self.folder = os.path.join(out, 'retex', name[:-4].replace('/', '+'))
        self.source = os.path.join(pov.EXAMPLES, os.path.dirname(name))

    def render(self, extra, log):
        command = ['nice', self.program, '-q', '--plain', '--size', f'{pov.WIDTH}x{pov.HEIGHT}', '--threads',
                   str(THREADS), *[word for k, v in self.options.items() for word in ('-D', f'{k}={v}')], *extra,
                   os.path.basename(self.name)]
        return pov.timed(command, self.source, log)

    def stamp(self):
        return os.stat(self.program).st_mtime

    def result(self):
        """The stored result, or None if the renderer is newer."""
        try:
            with open(os.path.join(self.folder, 'result.json'), encoding='ascii') as file:
                result = json.load(file)
            return result if result['stamp'] == self.stamp() else None
        except (OSError, ValueError, KeyError):
            return None

    def make(self):
        os.makedirs(self.folder, exist_ok=True)
        at = lambda name: os.path.join(self.folder, name)
        result = {'scene': self.name, 'stamp': self.stamp(), 'error': '', 'missing': []}
        again = os.environ.get('PARITY_TIMES') == 'again'
        if again and self.reference.read() and not self.reference.read().get('error'):
            self.reference.time_again()
        once = ['--spp', '1', '-o', at('one.exr')]
        status, result['cpu'], result['elapsed'] = self.render(once, at('log'))
        result['stops'] = status != 0
        if status: # what is missing is told, and the rest compared
            status, result['cpu'], result['elapsed'] = self.render(['--lenient', *once], at('log'))
        if status == 0:
            status, _, _ = self.render(['--lenient', '--spp', '16', '--aov', 'depth,albedo,normal', '--aov-dir',
                                        at('aov'), '-o', at('one.exr')], at('log'))
        with open(at('log'), encoding='latin-1') as file:
            log = file.read()
        result['missing'] = sorted(set(re.findall(r'warning: `([^`]*)` is not supported', log)))
        if status:
            errors = [line for line in log.splitlines() if 'error:' in line]
            result['error'] = (errors[0].split('error: ', 1)[1] if errors else f'status {status}')
        if os.path.exists(at('one.exr')):
            os.remove(at('one.exr'))
        ours = None
        if not status:
            ours = {name: pov.read_image(at(f'aov/{name}.exr')) for name in ('depth', 'albedo', 'normal')}
        self.compare(result, ours)
        with open(at('result.json'), 'w', encoding='ascii') as file:
            json.dump(result, file)
        return result

    def compare(self, result, ours):
        depth = ours['depth'][:, :, 0] if ours else np.full((pov.HEIGHT, pov.WIDTH), np.inf)
        near = depth[np.isfinite(depth)]
        theirs = self.reference.read() or self.reference.make(float(np.median(near)) if near.size else 0)
        if not theirs.get('error') and 'bumps' not in theirs:
            theirs = self.reference.renew_normal()
        result['povray_error'] = theirs.get('error', '')
        if result['povray_error']:
            return
        result['povray_cpu'], result['povray_elapsed'] = theirs['cpu'], theirs['elapsed']
        if not ours:
            return
        hit = np.isfinite(theirs['depth'])
        with np.errstate(invalid='ignore'):
            same = np.where(hit, np.abs(depth - theirs['depth']) <= CLOSE * theirs['depth'],
                            depth > theirs['far'] * (1 - CLOSE))
        result['depth'] = float(np.mean(same))
        both = np.ones_like(hit) if not hit.any() else hit
        if self.reference.read_layers() is None:
            self.reference.add_layers()
        difference = albedo_difference(ours['albedo'][:, :, :3], theirs['albedo'], self.reference.read_layers())
        result['albedo'] = float(difference[both].mean()) if hit.any() else 0.0
        lit = hit & same & (np.abs(theirs['normal']).sum(axis=2) > 0)
        cosines = (ours['normal'][:, :, :3] * theirs['normal']).sum(axis=2)
        result['normal'] = float(np.mean(cosines[lit] > ANGLE)) if lit.any() else None
        top = np.max(theirs['depth'][hit], initial=1e-9)
        grey = np.where(hit, 0.25 + 0.5 * (1 - np.minimum(theirs['depth'] / top, 1)), 0.1)
        pov.write_png(os.path.join(self.folder, 'depth.png'),
                      np.where(same[:, :, None], grey[:, :, None], [0.9, 0.1, 0.1]) * np.ones(3))


def line(r):
    normal = '-' if r.get('normal') is None else f"{100 * r['normal']:.1f}"
    if 'depth' in r:
        return (f"{r['scene']}: depth {100 * r['depth']:.2f} %, albedo {r['albedo']:.3f}, normal {normal} %, "
                f"{r['cpu']:.2f} s, POV-Ray {r['povray_cpu']:.2f} s")
    return f"{r['scene']}: {r['error'] or r['povray_error']}"


def explanation(r, notes):
    if r['error']:
        return 'stops: ' + r['error']
    if r['povray_error']:
        return 'no reference: ' + r['povray_error']
    words = [', '.join(f'`{m}`' for m in r['missing'])] if r['missing'] else []
    if r['stops']:
        words.insert(0, 'stops without --lenient')
    words += [notes[r['scene']]] if r['scene'] in notes else []
    return '; '.join(words) or ('' if r['depth'] >= ENOUGH else '**not explained**')


def order(r):
    return (r.get('depth', -1) >= ENOUGH, r.get('depth', -1), r['scene'])


def totals(results):
    done = [r for r in results if 'depth' in r]
    timed = [r for r in results if not r['error'] and 'povray_cpu' in r]
    middle = lambda name: float(np.median([r[name] for r in done if r.get(name) is not None] or [0]))
    return [('scenes', len(results)), ('scenes that render', sum(not r['stops'] for r in results)),
            ('scenes with 99 % of their pixels at POV-Ray\'s depth', sum(r['depth'] >= ENOUGH for r in done)),
            ('difference of albedo, median', f"{middle('albedo'):.3f}"),
            ('share of normals within 5 degrees, median', f"{100 * middle('normal'):.1f} %"),
            ('processor time, all scenes', f"{sum(r['cpu'] for r in timed):.1f} s"),
            ('processor time of POV-Ray', f"{sum(r['povray_cpu'] for r in timed):.1f} s"),
            ('scenes that take longer than POV-Ray', sum(r['cpu'] > r['povray_cpu'] for r in timed))]


def page(results, notes, out):
    percent = lambda v: '' if v is None else f'{100 * v:.1f}'
    number = lambda v, digits: '' if v is None else f'{v:.{digits}f}'
    with open(os.path.join(out, 'parity.md'), 'w', encoding='utf-8') as file:
        for name, value in totals(results):
            file.write(f'| {name} | {value} |\n' if name != 'scenes' else f'| {name} | {value} |\n|---|---|\n')
        file.write('\n| scene | depth % | albedo | normal % | s | POV-Ray s | not supported, or why |\n'
                   '|---|--:|--:|--:|--:|--:|---|\n')
        for r in sorted(results, key=order):
            file.write(f"| {r['scene'][:-4]} | {percent(r.get('depth'))} | {number(r.get('albedo'), 3)} | "
                       f"{percent(r.get('normal'))} | {number(r['cpu'], 2)} | {number(r.get('povray_cpu'), 2)} | "
                       f"{explanation(r, notes).replace('|', '/')} |\n")
    with open(os.path.join(out, 'parity.csv'), 'w', encoding='utf-8', newline='') as file:
        rows = csv.writer(file, lineterminator='\n')
        rows.writerow(['scene', 'depth', 'albedo', 'normal', 'seconds', 'povray_seconds', 'why'])
        for r in sorted(results, key=order):
            rows.writerow([r['scene'], number(r.get('depth'), 4), number(r.get('albedo'), 4),
                           number(r.get('normal'), 4), number(r['cpu'], 3), number(r.get('povray_cpu'), 3),
                           explanation(r, notes).replace('`', '').replace('*', '')])


def sheet(results, notes, out):
    with open(os.path.join(out, 'sheet.html'), 'w', encoding='utf-8') as file:
        file.write('<!doctype html><meta charset="utf-8"><title>Samples of POV-Ray</title>'
                   '<style>body{font:13px sans-serif;background:#777;color:#fff}td{padding:4px;vertical-align:top}'
                   'img{width:320px;height:240px}</style>'
                   '<table><tr><th>retex<th>POV-Ray<th>red: another depth<th></tr>\n')
        for r in sorted(results, key=order):
            name = r['scene'][:-4].replace('/', '+')
            cells = ''.join(f'<td><img loading="lazy" src="{p}" alt="">' for p in
                            (f'retex/{name}/aov/beauty.png', f'povray/{name}/shaded.png', f'retex/{name}/depth.png'))
            file.write(f'<tr>{cells}<td>{html.escape(line(r))}<br>{html.escape(explanation(r, notes))}</tr>\n')
        file.write('</table>\n')


def read_list(path):
    with open(path, encoding='utf-8') as file:
        words = [row.split() for row in file if row.strip() and not row.startswith('#')]
    return {row[1]: options_of(row[2:]) for row in words}


def read_notes(path):
    """Lines 'scene: why'."""
    with open(path, encoding='utf-8') as file:
        return dict(row.strip().split(': ', 1) for row in file if row.strip() and not row.startswith('#'))


def main(build, out, path, names):
    os.makedirs(out, exist_ok=True)
    pov.make_trees(out)
    known = read_list(path)
    chosen = [name for name in known if not names or any(word in name for word in names)]
    if not chosen:
        sys.exit('parity: no scene has such a name')
    notes = read_notes(os.path.join(os.path.dirname(__file__), 'notes.txt'))

    def one(name):
        scene = Scene(build, out, name, known[name])
        result = scene.result()
        if result is None or os.environ.get('PARITY_TIMES') == 'again':
            result = scene.make()
        print(line(result), flush=True)
        return result

    jobs = int(os.environ.get('PARITY_JOBS', '2'))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        results = list(pool.map(one, chosen))
    sheet(results, notes, out)
    if not names:
        page(results, notes, out)
    for name, value in totals(results):
        print(f'{name}: {value}')
    print(f'sheet: {out}/sheet.html')


main(sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:])

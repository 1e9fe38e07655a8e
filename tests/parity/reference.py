"""What POV-Ray itself shows of a scene: distance, albedo and normal of what each pixel's ray meets first, and the shaded
picture with its time. Kept in a folder for each scene, because POV-Ray's pictures do not change.

POV-Ray has no such pictures of its own. They are made thus, with one ray for each pixel and linear OpenEXR:
- albedo: quality 1, which shows pigments alone, without what is behind transparent ones; of layers the bottom one.
- layers: all surfaces shine by `ambient` alone, in a copy of the scene whose finishes are ended with that. A surface shows
  its colour times its opacity, and layers show what they have together.
- depth: fog is added to the scene. What fog adds to a pixel is C (1 - exp(-depth / D)); the same picture with black fog is
  subtracted, in the darkest channel. With max_trace_level 1, nothing is seen in mirrors or through transparent surfaces.
- normal: one parallel light without shadows or highlights is added along each axis, at quality 8, which has bumps; with
  max_trace_level 1.

These pictures are made of prepared copies of the scenes: fog of their own is moved out of sight, cameras have no focal
blur, finishes have no highlights and `brilliance` 1, quick_color is taken out. What is inverse or
clipped is hollow. Shaded pictures are made of unchanged copies, because some scenes write files."""
import concurrent.futures, glob, json, os, re, shutil, subprocess, time
import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 160, 120
EXAMPLES = '/usr/share/doc/povray/examples'
INCLUDES = '/usr/share/povray-3.7/include'
FOG = 6e4           # its colour, near the largest half
FAR = 4.2           # depths beyond so many D are 'far': too little of the fog's colour is missing there
HALF_MAX = 65000    # depths beyond are far, too: half floats do not have them
LIGHT = 100.0
TIMEOUT = 600


def read_image(path):
    pixels = oiio.ImageBuf(path).get_pixels(oiio.FLOAT)
    if pixels is None or pixels.size == 0:
        raise OSError(f'{path} cannot be read')
    return np.asarray(pixels, dtype=np.float64)


def write_png(path, pixels):
    out = oiio.ImageOutput.create(path)
    pixels = np.clip(np.rint(pixels * 255), 0, 255).astype(np.uint8)
    if not out or not out.open(path, oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.UINT8)):
        raise OSError(f'{path} cannot be written')
    out.write_image(np.ascontiguousarray(pixels))
    out.close()


def srgb(linear):
    c = np.clip(np.nan_to_num(linear), 0, 1)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def timed(command, folder, log, settings=None):
    """Run a process, with more environment; its exit status, processor time and elapsed time in seconds."""
    start = time.monotonic()
    with open(log, 'wb') as errors:
        child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                 stderr=errors, env={**os.environ, **(settings or {})})
        try:
            while True:
                pid, status, usage = os.wait4(child.pid, os.WNOHANG)
                if pid:
                    break
                if time.monotonic() - start > TIMEOUT:
                    child.kill()
                time.sleep(0.002)
        except BaseException:
            child.kill()
            raise
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, usage.ru_utime + usage.ru_stime, time.monotonic() - start


def closing_brace(text, start):
    depth = 0
    for k in range(start, len(text)):
        if text[k] == '{':
            depth += 1
        elif text[k] == '}':
            depth -= 1
            if depth == 0:
                return k
    return -1


def prepared(text):
    """The text of a scene without what would be in the way of measuring depth and albedo."""
    at = 0
    while True:
        fog = re.compile(r'\bfog\s*\{').search(text, at)
        if not fog:
            break
        end = closing_brace(text, fog.end() - 1)
        if end < 0:
            break
        text = text[:end] + '\n distance 1e25 ' + text[end:]
        at = fog.end()
    # within what is not hollow, POV-Ray has no fog
    text = re.sub(r'\binverse\b(?=\s*[}\s])', 'inverse hollow', text)
    text = re.sub(r'\bclipped_by\b(?=\s*\{)', 'hollow clipped_by', text)
    text = re.sub(r'\bbrilliance\b(?=[\s(])', 'brilliance 1+0*', text)
    text = re.sub(r'\b(phong|specular)(\s+albedo)?\b(?=[\s(])', r'\1\2 0*', text)
    text = re.sub(r'\baperture\b(?=[\s(])', 'aperture 0*', text)
    number = r'[-+]?[\d.]+'
    return re.sub(r'\bquick_colou?r\s+((?:(?:red|green|blue|filter|transmit)\s+' + number + r'\s*)+|rgb\w*\s*<[^>]*>|'
                  r'rgb\w*\s+' + number + r'|[A-Z]\w*)', '', text)


SHINES = ' ambient rgb 1 diffuse 0 emission 0 phong 0 specular 0 reflection { 0 } '


def code_of(text):
    """The text with blanks in place of comments and strings."""
    blank = lambda match: re.sub(r'[^\n]', ' ', match.group())
    return re.sub(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def shining(text):
    """The text of a prepared scene with finishes that do nothing but shine; media and radiosity are off below quality 9."""
    code, parts, done = code_of(text), [], 0
    for finish in re.finditer(r'\bfinish\s*\{', code):
        end = closing_brace(code, finish.end() - 1)
        if end >= done:
            parts += [text[done:end], '\n' + SHINES]
            done = end
    return ''.join(parts) + text[done:]


def with_default(text):
    """Textures without a finish shine too."""
    version = re.search(r'^\s*#version[^;]*;', text, re.M)
    at = version.end() if version else 0
    return text[:at] + f'\n#default {{ finish {{ {SHINES} }} }}\n' + text[at:]


def make_trees(work):
    """Copies of all samples: as they are, prepared, and prepared with finishes that shine."""
    for name in ('plain', 'prepared', 'shining'):
        tree = os.path.join(work, name)
        if os.path.isdir(tree):
            continue
        shutil.rmtree(tree + '.new', ignore_errors=True)
        shutil.copytree(EXAMPLES, tree + '.new')
        if name != 'plain':
            shutil.copytree(INCLUDES, tree + '.new/include', dirs_exist_ok=True)
            with open(tree + '.new/povray.ini', 'w', encoding='ascii') as file:
                file.write(f'Library_Path="{tree}/include"\n')
            for path in glob.glob(tree + '.new/**/*', recursive=True):
                if path.endswith(('.pov', '.inc')):
                    with open(path, encoding='latin-1', newline='') as file:
                        text = file.read()
                    new = shining(prepared(text)) if name == 'shining' else prepared(text)
                    if new != text:
                        with open(path, 'w', encoding='latin-1', newline='') as file:
                            file.write(new)
        os.rename(tree + '.new', tree)


class Reference:
    def __init__(self, work, scene, options):
        """options: values that the scene needs, as {'clock': '1', 'frame_number': '1'}."""
        self.work, self.scene = work, scene
        self.folder = os.path.join(work, 'povray', scene[:-4].replace('/', '+'))
        self.frames = []
        if options:
            frame = options.get('frame_number', '0')
            clock = options.get('clock', '0')
            # an animation of two frames, of which the first is rendered: one frame alone has number 0
            self.frames = [f'+KFI{frame}', f'+KFF{int(frame) + 1}', f'+SF{frame}', f'+EF{frame}', f'+KI{clock}',
                           f'+KF{clock}']

    def path(self, name):
        return os.path.join(self.folder, name)

    def povray(self, tree, file, options, name):
        """A picture by POV-Ray, and its times."""
        base = self.path(name)
        command = ['nice', 'povray', f'+I{file}', f'+W{WIDTH}', f'+H{HEIGHT}', '-D', '-A', '-J', '+FE',
                   f'+O{base}.exr', *options, *self.frames]
        settings = {'POVINI': os.path.join(self.work, tree, 'povray.ini')} if tree != 'plain' else None
        for _ in range(2): # scenes that write files are in each other's way
            for old in glob.glob(glob.escape(base) + '*.exr'):
                os.remove(old)
            status, used, elapsed = timed(command, os.path.join(self.work, tree, os.path.dirname(self.scene)),
                                          base + '.log', settings)
            made = glob.glob(glob.escape(base) + '*.exr')
            if status == 0 and made:
                picture = read_image(made[0])[:, :, :3]
                os.remove(made[0])
                os.remove(base + '.log')
                return picture, used, elapsed
        with open(base + '.log', encoding='latin-1') as log:
            why = [line.strip() for line in log if 'rror' in line]
        raise RuntimeError('POV-Ray: ' + (why[0] if why else f'status {status}'))

    def wrapped(self, quality, text, name):
        """A picture of the prepared scene with more text at its end, in a linear working space."""
        wrapper = self.path(name + '.pov')
        with open(os.path.join(self.work, 'prepared', self.scene), encoding='latin-1', newline='') as file:
            scene = file.read()
        with open(wrapper, 'w', encoding='latin-1', newline='') as file:
            file.write(f'global_settings {{ assumed_gamma 1 }}\n{scene}\n{text}\n')
        picture = self.povray('prepared', wrapper, [f'+Q{quality}', '+WT1'], name)[0]
        os.remove(wrapper)
        return picture

    def layers(self):
        """What surfaces shine with."""
        wrapper = self.path('layers.pov')
        with open(os.path.join(self.work, 'shining', self.scene), encoding='latin-1', newline='') as file:
            scene = file.read()
        with open(wrapper, 'w', encoding='latin-1', newline='') as file:
            file.write(with_default(scene) + '\nglobal_settings { max_trace_level 1 ambient_light rgb 1 }\n')
        picture = self.povray('shining', wrapper, ['+Q8', '+WT1'], 'layers')[0]
        os.remove(wrapper)
        return picture

    def fog(self, distance, colour):
        return self.wrapped(9, f'global_settings {{ max_trace_level 1 }} fog {{ distance {distance:g} '
                               f'color rgb {colour:g} }}', f'fog{colour:g}')

    def depth(self, guess):
        """Depth by pixel, infinite where it is far or nothing is met, and what is far."""
        distance = 300 * guess if guess else 1e4
        for _ in range(4):
            black = self.fog(distance, 0)
            darkest = black.argmin(axis=2)[:, :, None] # the channel that half floats keep best
            share = np.take_along_axis((self.fog(distance, FOG) - black) / FOG, darkest, 2)[:, :, 0]
            seen = share[(share < 0.999) & (share > 0)]
            middle = np.median(seen) if seen.size else 0.003
            if 3e-4 < middle < 0.1:
                break
            distance *= 300 * -np.log1p(-min(max(middle, 1e-6), 0.99))
        depth = -distance * np.log1p(-np.clip(share, 0, 1 - 1e-9))
        far = min(FAR * distance, HALF_MAX)
        depth[(depth > far) | (share <= 0)] = np.inf # 0: the camera has no ray there
        return depth, far

    def normal(self, pool):
        """Normals, towards the camera, and 0 where no light of the six is seen."""
        lights = ['global_settings { max_trace_level 1 }']
        for sign in (1, -1):
            for axis in range(3):
                place = ['0', '0', '0']
                place[axis] = f'{sign * 10000000}'
                lights.append(f'light_source {{ <{",".join(place)}>, rgb {LIGHT} parallel shadowless '
                              f'point_at 0 }} {lights[0]}')
        jobs = [pool.submit(self.wrapped, 8, text, f'light{k}') for k, text in enumerate(lights)]
        pictures = [job.result().sum(axis=2) for job in jobs]
        towards = [np.maximum(picture - pictures[0], 0) for picture in pictures[1:]]
        normal = np.stack([towards[k] - towards[k + 3] for k in range(3)], axis=2)
        length = np.linalg.norm(normal, axis=2)
        return np.where(length[:, :, None] > 0.01 * LIGHT, normal / np.maximum(length, 1e-9)[:, :, None], 0)

    def read(self):
        """None if it is not complete."""
        try:
            with open(self.path('reference.json'), encoding='ascii') as file:
                info = json.load(file)
            if info.get('error'):
                return info
            arrays = np.load(self.path('reference.npz'))
            return {**info, **{name: arrays[name].astype(np.float64) for name in arrays.files}}
        except (OSError, ValueError):
            return None

    def renew_normal(self):
        """The normals of pictures that were made without bumps."""
        known = self.read()
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            normal = self.normal(pool)
        np.savez_compressed(self.path('reference.npz'), depth=known['depth'].astype(np.float32),
                            albedo=known['albedo'].astype(np.float32), normal=normal.astype(np.float32))
        self.write({**{k: v for k, v in known.items() if not isinstance(v, np.ndarray)}, 'bumps': 1})
        return self.read()

    def add_layers(self):
        """Layers, to pictures that were made without them. Where POV-Ray refuses, there are none."""
        try:
            layers = self.layers()
        except RuntimeError:
            layers = self.read()['albedo']
        np.savez_compressed(self.path('layers.npz'), layers=layers.astype(np.float32))

    def read_layers(self):
        try:
            return np.load(self.path('layers.npz'))['layers'].astype(np.float64)
        except (OSError, ValueError, KeyError):
            return None

    def make(self, guess):
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        file = os.path.basename(self.scene)
        info = {'bumps': 1}
        try:
            with concurrent.futures.ThreadPoolExecutor(3) as pool:
                albedo = pool.submit(self.povray, 'prepared', file, ['+Q1', '+WT1'], 'albedo')
                depth = pool.submit(self.depth, guess)
                normal = self.normal(pool)
                depth, info['far'] = depth.result()
                albedo = albedo.result()[0]
            shaded, info['cpu'], info['elapsed'] = self.povray('plain', file, ['+WT2'], 'shaded')
            np.savez_compressed(self.path('reference.npz'), depth=depth.astype(np.float32),
                                albedo=albedo.astype(np.float32), normal=normal.astype(np.float32))
            write_png(self.path('shaded.png'), srgb(shaded))
            self.write(info)
        except RuntimeError as error:
            self.write({'error': str(error)})
        return self.read()

    def write(self, info):
        with open(self.path('reference.json') + '.new', 'w', encoding='ascii') as out:
            json.dump(info, out)
        os.rename(self.path('reference.json') + '.new', self.path('reference.json'))

    def time_again(self):
        """POV-Ray's time on the machine as it is now."""
        info = {k: v for k, v in self.read().items() if not isinstance(v, np.ndarray)}
        _, info['cpu'], info['elapsed'] = self.povray('plain', os.path.basename(self.scene), ['+WT2'], 'timed')
        self.write(info)

#!/usr/bin/env python3
"""Memory of large scenes, as a user meets it: python3 tests/bench/memory_figures.py BIN_FOLDER WORK_FOLDER [samples] [paths]

1. What one rank and four ranks hold of the geometry's arrays, summed as PSS of the mapped files, plain and packed.
2. A hilly terrain under --memory with a third of what it takes: same bytes, CPU seconds and peak against no limit.
"""
import array, filecmp, glob, math, os, subprocess, sys, time

binary, work = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
samples = int(sys.argv[3]) if len(sys.argv) > 3 else 1500
paths = int(sys.argv[4]) if len(sys.argv) > 4 else 16
gsd = 10.0
os.makedirs(work, exist_ok=True)
os.chdir(work)
os.environ.update({'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1',
                   'OMPI_MCA_rmaps_base_oversubscribe': '1', 'OMPI_MCA_hwloc_base_binding_policy': 'none'})


def make():
    waves = [(150 * 0.5**k, 0.0004 * 2.1**k, k) for k in range(6)]
    along = [[math.sin(1.3 * f * i * gsd + k) for i in range(samples)] for _, f, k in waves]
    with open('hills.img', 'wb') as file:
        for j in range(samples):
            c = [a * math.cos(f * j * gsd + 1.7 * k) for a, f, k in waves]
            array.array('f', (sum(w * x[i] for w, x in zip(c, along)) for i in range(samples))).tofile(file)
    open('hills.img.hdr', 'w').write('ENVI\nsamples = %d\nlines = %d\nbands = 1\nheader offset = 0\ndata type = 4\n'
                                     'interleave = bsq\nbyte order = 0\n' % (samples, samples))
    half = samples * gsd / 2
    open('hills.yaml', 'w').write('scene: 1\nmaterials: {soil: {model: lambert, reflectance: 0.3}}\n'
                                  'objects: {ground: {terrain: hills.img, local: {origin: [%g, %g], gsd: %g}, '
                                  'material: soil, tile_m: 2000}}\nworld: [{place: ground}]\n' % (-half, half, gsd))
    for name, how in (('plain', 'none'), ('packed', 'deflate:1')):
        subprocess.check_call([binary + '/scene-prep', 'hills.yaml', '-o', name + '.h5', '--compress', how, '-q'],
                              stdout=subprocess.DEVNULL)
        open(name + '.yaml', 'w').write(
            'scene: %s.h5\nseed: 1\nmax_nodes: 4\nsun: {direction: {zenith_deg: 40, azimuth_deg: 135}, irradiance: '
            '1500}\nsky: {radiance: 40}\nsensors:\n  - {kind: frame_camera, name: cam, columns: 160, rows: 160, '
            'pitch_um: 50, focal_length_mm: 16, position_m: [0, 0, %g], look_at_m: [0, 0, 0], up: [0, 1, 0], bands: '
            '[{name: green, center_um: 0.55, fwhm_um: 0.02, shape: rectangular}], paths: %d}\n' % (name, 4 * half, paths))


def mapped(ours):
    """MB of scene files and nameless files that the processes map, their share of each page."""
    total = 0
    for status in glob.glob('/proc/[0-9]*/smaps'):
        try:
            if os.readlink(os.path.dirname(status) + '/exe') != ours:
                continue
            counts = False
            for line in open(status):
                word = line.split()
                if '-' in word[0]:
                    name = word[5] if len(word) > 5 else ''
                    counts = name.endswith('.h5') or (len(word) > 6 and word[6] == '(deleted)' and '/#' in name)
                elif counts and word[0] == 'Pss:':
                    total += int(word[1]) / 1024
        except OSError:
            pass
    return total


def geometry_of(ranks, name):
    command = [binary + '/dirsig-render', name + '.yaml', '-j', '1', '-q', '-o', 'ranks']
    run = subprocess.Popen((['mpirun', '-n', str(ranks)] if ranks > 1 else []) + command, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
    most = 0
    while run.poll() is None:
        most = max(most, mapped(os.path.realpath(binary + '/dirsig-render')))
        time.sleep(0.1)
    return most


def render(out, *more):
    run = subprocess.Popen([binary + '/dirsig-render', 'plain.yaml', '-o', out, *more], stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True)
    text = run.stderr.read()
    _, status, used = os.wait4(run.pid, 0)
    if status:
        sys.exit(text)
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, [l for l in text.splitlines() if l.startswith('tiles')]


make()
for name in ('plain', 'packed'):
    one, four = geometry_of(1, name), geometry_of(4, name)
    print('geometry, %s: one rank %.1f MB, four ranks %.1f MB, %.2f times' % (name, one, four, four / one))
free_cpu, free_peak, tiles = render('free', '--memory', '1024GiB')
numbers = [w for w in tiles[0].replace(':', '').replace(',', '').split()]
scale = {'MB': 1.0, 'GB': 1000.0}
sizes = [float(v) * scale[u] for v, u in zip(numbers, numbers[1:]) if u in scale]
limit = sum(sizes) / 3
cpu, peak, tiles = render('limited', '--memory', '%.0fMiB' % (limit / 1.048576))
same = filecmp.cmp('free/cam.img', 'limited/cam.img', False)
print('terrain: %.0f MB without a limit, %.0f MB allowed: %s bytes, %.1f s of CPU against %.1f, %.2f times; '
      'peak of the process %.0f MB against %.0f' % (sum(sizes), limit, 'same' if same else 'OTHER', cpu, free_cpu,
                                                   cpu / free_cpu, peak, free_peak))
print(tiles[0])

"""What every scene has in common, as text for each program: camera, sun, sky, grey surfaces. All three are written from the same
figures; sources are the same number in every channel (a constant spectrum is not white in Mitsuba's RGB, which is sRGB)."""
import math
import struct
from dataclasses import dataclass

SUN = (0.5, -0.3, 0.8)  # towards the sun
# Scattering events of a path, more than roulette leaves any: where programs cut, they do not cut the same light.
NODES = 64


@dataclass
class Scene:
    """A scene as the three programs read it. mitsuba, pbrt: shapes and lights of their own; objects ... lamps: of our texts."""
    name: str
    camera: tuple
    target: tuple
    fov_deg: float
    mitsuba: str
    materials: str
    objects: str
    world: list
    pbrt: str = ""
    sun: float = 0      # irradiance on a plane that faces it
    sky: float = 0      # radiance of the whole sphere
    lamps: str = ""
    volumes: str = ""   # media, grids and volumes
    channels: str = ""  # of "rgb": bands of 1 nm at 0.65, 0.55, 0.45 um against those channels of Mitsuba's; else one grey band
    volumetric: bool = False
    fitted: tuple = ()  # (FIT, options of sqt-fit, first of all the .bsdf) that make FIT.sqt
    exact: float = 0    # radiance of every pixel, where it is known


def rgb(name, value):
    return f'<rgb name="{name}" value="{value}, {value}, {value}"/>'


def diffuse(reflectance):
    return f'<bsdf type="twosided"><bsdf type="diffuse">{rgb("reflectance", reflectance)}</bsdf></bsdf>'


def leaf(reflectance, transmittance):
    """Reflects and transmits diffusely: Mitsuba has it as the diffuse part of its thin principled model, all of it transmitted."""
    both = reflectance + transmittance
    return (f'<bsdf type="blendbsdf"><float name="weight" value="{transmittance / both!r}"/>{diffuse(both)}<bsdf type="principledthin">'
            f'{rgb("base_color", both)}<float name="diff_trans" value="2"/><float name="spec_trans" value="0"/><float name="roughness" value="1"/></bsdf></bsdf>')


def turned_xml(scale=(1, 1, 1), turns=(), translate=(0, 0, 0)):
    """turns: (axis, degrees), one after the other."""
    text = '<transform name="to_world"><scale x="%.9g" y="%.9g" z="%.9g"/>' % tuple(scale)
    for axis, degrees in turns:
        text += f'<rotate {axis}="1" angle="{degrees:.9g}"/>'
    return text + '<translate x="%.9g" y="%.9g" z="%.9g"/></transform>' % tuple(translate)


def mitsuba_xml(s, edge):
    lights = f'<emitter type="constant">{rgb("radiance", s.sky)}</emitter>' if s.sky else ""
    if s.sun:
        lights += ('<emitter type="directional"><vector name="direction" value="%g, %g, %g"/>%s</emitter>'
                   % (*(-c for c in SUN), rgb("irradiance", s.sun)))
    return f"""<scene version="3.0.0"><default name="sampler" value="multijitter"/>
<integrator type="{"volpath" if s.volumetric else "path"}"><integer name="max_depth" value="-1"/></integrator>
<sensor type="perspective"><float name="fov" value="{s.fov_deg}"/><transform name="to_world">
<lookat origin="{s.camera[0]}, {s.camera[1]}, {s.camera[2]}" target="{s.target[0]}, {s.target[1]}, {s.target[2]}" up="0, 0, 1"/></transform>
<sampler type="$sampler"><integer name="sample_count" value="16"/></sampler>
<film type="hdrfilm"><integer name="width" value="{edge}"/><integer name="height" value="{edge}"/>
<string name="pixel_format" value="{"rgb" if s.channels else "luminance"}"/>
<string name="component_format" value="float32"/><rfilter type="box"/></film></sensor>
{lights}{s.mitsuba}</scene>
"""


def pbrt_text(s, edge):
    light = ""
    if s.sun:
        light = ('LightSource "distant" "point3 from" [%g %g %g] "point3 to" [0 0 0] "spectrum L" [300 %g 900 %g] "float scale" 1\n'
                 % (*SUN, s.sun, s.sun))
    return f"""LookAt {s.camera[0]} {s.camera[1]} {s.camera[2]}  {s.target[0]} {s.target[1]} {s.target[2]}  0 0 1
Camera "perspective" "float fov" {s.fov_deg}
Sampler "zsobol" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" {NODES}
Film "rgb" "integer xresolution" {edge} "integer yresolution" {edge} "string filename" "out.exr"
PixelFilter "box"
WorldBegin
{light}LightSource "infinite" "spectrum L" [300 {s.sky} 900 {s.sky}]
{s.pbrt}
"""


def our_scene(s):
    return (f"scene: 1\nmaterials: {{{s.materials}}}\n{s.volumes}objects: {{{s.objects}}}\nworld:\n" + "".join(f"  - {p}\n" for p in s.world))


def our_simulation(s, edge):
    sun = ""
    if s.sun:
        zenith = math.degrees(math.acos(SUN[2] / math.sqrt(sum(c * c for c in SUN))))
        azimuth = math.degrees(math.atan2(SUN[0], SUN[1])) % 360
        sun = f"sun: {{direction: {{zenith_deg: {zenith:.9g}, azimuth_deg: {azimuth:.9g}}}, irradiance: {s.sun}, collimated: true}}\n"
    sky = f"sky: {{radiance: {s.sky}, full_sphere: true}}\n" if s.sky else ""
    centers = {"r": 0.65, "g": 0.55, "b": 0.45}
    bands = [f"{{name: {n}, center_um: {centers[n]}, fwhm_um: 0.001}}" for n in s.channels] or ["{name: grey, center_um: 0.55, fwhm_um: 0.01}"]
    return f"""scene: {s.name}.h5
max_nodes: {NODES}
max_scatterings: 10000000
{sun}{sky}{s.lamps}sensors:
  - {{kind: frame_camera, name: camera, columns: {edge}, rows: {edge}, pitch_um: {2e5 * math.tan(math.radians(s.fov_deg / 2)) / edge}, focal_length_mm: 100,
     position_m: [{s.camera[0]}, {s.camera[1]}, {s.camera[2]}], look_at_m: [{s.target[0]}, {s.target[1]}, {s.target[2]}], truth: [], bands: [{", ".join(bands)}], paths: 64}}
"""


def write_mesh(base, points, triangles):
    """The same triangles as base.ply and base.obj."""
    with open(base + ".ply", "wb") as out:
        out.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        for p in points:
            out.write(struct.pack("<3f", *p))
        for t in triangles:
            out.write(struct.pack("<B3i", 3, *t))
    with open(base + ".obj", "w") as out:
        out.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in points)
        out.writelines("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in triangles)


def ply(name, bsdf):
    return f'<shape type="ply"><string name="filename" value="{name}.ply"/><boolean name="face_normals" value="true"/>{bsdf}</shape>'

# SPDX-License-Identifier: Apache-2.0
"""Tests the add-on in a 3D view of a Blender with a window: the view orbits, a lamp moves, a mesh is edited; the final
picture is the same, byte for byte, as the program renders of the whole scene, and it is on the screen. Material Preview
shows base colours. Run inside Blender:

    WINDOW=1 run.sh viewport.py ADDON.zip PENUMBRA WORK
"""

import os
import subprocess
import sys
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402
from bpy_extras.view3d_utils import location_3d_to_region_2d  # noqa: E402
from mathutils import Quaternion  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402
from window import clear, final, on_screen, run, shown, until, view_3d  # noqa: E402

claims = []


def expect(claim, what):
    claims.append(bool(claim))
    if not claim:
        print(f"compare: FAILED: {what}", flush=True)


def out(name):
    return os.path.join(inside.OUT, name)


def compare_with_program(what):
    from penumbra import exr, viewport
    view = shown()
    viewport.write_whole(out("whole.glb"), bpy.context.evaluated_depsgraph_get(), view._viewpoint)
    subprocess.run([inside.PENUMBRA, "render", out("whole.glb"), "-o", out("whole.exr"), "--no-studio", "--lenient", "-q",
                    "--size", "{}x{}".format(*view._viewpoint.size)], check=True)
    with open(out("whole.exr"), "rb") as file:
        whole = exr.read(file.read()).channels
    picture = view.picture
    expect(picture.rgba.shape[1::-1] == view._viewpoint.size, f"{what}: as many pixels as the view has")
    for number, letter in enumerate("RGBA"):
        expect(picture.rgba[..., number].tobytes() == whole[letter].tobytes(), f"{what}: {letter}")
    expect(picture.visibility, f"{what}: V comes, too")
    for light, values in picture.visibility.items():
        expect(values.tobytes() == whole[f"{light}.V"].tobytes(), f"{what}: V of {light}")
    expect(len(numpy.unique(picture.rgba)) > 1000, f"{what}: something is seen")


def displayed(picture):
    """Returns the smallest and the largest display values that a pixel may show of a picture over the grey world, first
    row at the bottom. They are those of its neighbours, because processor drivers weigh texels in 256 steps."""
    values = numpy.clip(picture.rgba[::-1, :, :3] + (1 - picture.rgba[::-1, :, 3:]) * 0.05, 0, 1)
    values = numpy.where(values < 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    near = [numpy.roll(values, (x, y), (0, 1)) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    return numpy.min(near, axis=0), numpy.max(near, axis=0)


def compare_with_screen(what, earlier=None):
    """Expects that the screen shows the picture, and not the earlier one."""
    inner = numpy.s_[24:-24, 24:-24]  # without rounded corners, and without arrows that open side bars

    def differ(picture):
        """Returns the share of pixels that differ by more than half floats, dithering and rounding to 8 bits can
        explain."""
        least, greatest = displayed(picture)
        return float((numpy.maximum(least - seen, seen - greatest)[inner].max(axis=-1) > 0.015).mean())
    for _ in range(20):
        yield 0.2
        seen = on_screen(out("screen.png"))
        if differ(shown().picture) == 0:
            break
    expect(differ(shown().picture) == 0, f"{what}: on the screen ({differ(shown().picture):.5f} of the pixels differ)")
    if earlier is not None:
        expect(differ(earlier) > 0.005, f"{what}: the screen does not show the earlier picture ({differ(earlier):.5f} of the pixels differ)")


def compare(what, earlier):
    compare_with_program(what)
    yield from compare_with_screen(what, earlier)
    return shown().picture


def painted(color):
    """Yields materials that show this colour by a Diffuse BSDF, by a Principled BSDF, and by the latter's picture."""
    def principled(name):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        return material, material.node_tree, material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    yield scenes.diffuse(color, "Diffuse only")
    material, _, base = principled("Principled")
    base.default_value = (*color, 1)
    yield material
    material, tree, base = principled("Picture")
    image = bpy.data.images.new("Paint", 4, 4)
    image.generated_color = (*color, 1)
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], base)
    yield material


def test_material_preview(area, region, space):
    """Cubes that are grey in Solid shading show their base colour in Material Preview, for which no program runs."""
    channel = {}
    for x, (color, number) in zip((2.4, 0.4, -1.6), (((0.7, 0.02, 0.02), 0), ((0.02, 0.5, 0.02), 1), ((0.02, 0.02, 0.8), 2))):
        for y, material in zip((-2.8, -1.8, 2.2), painted(color)):  # as seen from +x, no cube is behind another
            data = scenes.cube("Painted", material, 0.3)
            data.uv_layers.new()
            channel[scenes.add("Painted", data, (x, y, 0.31))] = number

    def ratios(name):
        """Yields for each cube how clearly its colour shows on the screen: its channel over the larger of the other
        two."""
        seen = on_screen(out(name))
        for cube, number in channel.items():
            x, y = (int(value) for value in location_3d_to_region_2d(region, space.region_3d, cube.location))
            color = seen[y - 1:y + 2, x - 1:x + 2].mean(axis=(0, 1))
            yield float(color[number] / max(numpy.delete(color, number)))
    child = shown().child
    space.shading.type = "SOLID"
    area.tag_redraw()
    yield 0.5
    solid = list(ratios("solid.png"))
    expect(max(solid) < 1.3, f"Solid shading shows grey: {solid}")
    space.shading.type = "MATERIAL"
    for _ in range(600):  # EEVEE compiles its shaders in the meantime
        area.tag_redraw()
        yield 0.5
        preview = list(ratios("preview.png"))
        if min(preview) > 1.5:
            break
    expect(min(preview) > 1.5, f"Material Preview shows base colours: {preview}")
    expect(child.process.poll() is not None and shown() is None, "no child works for Material Preview")


def note_exceptions():
    """Returns a list that will hold all exceptions, including those that Blender or the add-on catches and prints."""
    thrown, report, own = [], sys.excepthook, traceback.print_exc

    def hook(kind, error, where):
        thrown.append(error)
        report(kind, error, where)

    def printed(*arguments, **named):
        thrown.append(sys.exc_info()[1])
        own(*arguments, **named)
    sys.excepthook, traceback.print_exc = hook, printed
    return thrown


def test():
    from penumbra import serving
    thrown = note_exceptions()
    scene = inside.fresh(scenes.many_lamps)
    scene.view_settings.view_transform = "Standard"
    scene.render.film_transparent = False
    scene.world = bpy.data.worlds.new("Grey")
    scene.world.color = (0.05, 0.05, 0.05)
    sent, own = [], serving.Child.send

    def listen(child, head, data=b""):
        sent.append((head, data))
        own(child, head, data)
    serving.Child.send = listen
    yield 0.2
    area, region, space = view_3d()
    clear(space)
    place = space.region_3d
    place.view_distance, place.view_location = 9, (0, 0, 0.5)
    place.view_rotation = Quaternion((0.82, 0.42, 0.17, 0.34))
    space.shading.type = "RENDERED"
    yield from final("no first picture came")
    seen = yield from compare("the first picture", None)
    things = [head for head, _ in sent if head["type"] == "put"]
    expect(len(things) == 1, f"one file of all there is was sent: {len(things)}")
    # An orbit.
    sent.clear()
    pictures = set()
    for step in range(25):
        place.view_rotation = Quaternion((0, 0, 1), 0.03) @ place.view_rotation
        area.tag_redraw()
        yield 0.04
        pictures.add(id(shown().picture))
    yield from final("no picture came after an orbit")
    seen = yield from compare("an orbit", seen)
    expect(len(pictures) > 2, f"pictures come meanwhile: {len(pictures)}")
    expect({head["type"] for head, _ in sent} == {"show"}, "nothing but the camera was sent")
    # A lamp moves.
    sent.clear()
    bpy.data.objects["Area"].location.x -= 1.5
    yield from final("no picture came after a lamp moved")
    seen = yield from compare("a lamp that moved", seen)
    put = [data for head, data in sent if head["type"] == "put"]
    expect(put and all(b"Object/Area" in data and b"Block" not in data for data in put), "the lamp alone was sent")
    bpy.data.lights["Point"].energy *= 3
    yield from final("no picture came after a lamp was brightened")
    seen = yield from compare("a brighter lamp", seen)
    # A mesh is edited, an object is removed, another is added.
    sent.clear()
    mesh = bpy.data.objects["Block"].data
    for vertex in mesh.vertices:
        vertex.co.z *= 1.6
    mesh.update()
    yield from final("no picture came after a mesh was edited")
    seen = yield from compare("a mesh that was edited", seen)
    put = [data for head, data in sent if head["type"] == "put"]
    expect(put and all(b"Object/Block" in data and b"Object/Area" not in data for data in put), "the mesh alone was sent")
    bpy.data.objects["Disk"].hide_set(True)
    scenes.add("Other", scenes.cube("Other"), (-1.5, 0.5, 0.7), (0, 0, 20))
    bpy.data.materials["Diffuse"].node_tree.nodes["Diffuse BSDF"].inputs["Color"].default_value = (0.2, 0.7, 0.3, 1)
    yield from final("no picture came after objects came and went")
    seen = yield from compare("objects that came and went", seen)
    yield from test_material_preview(area, region, space)
    space.shading.type = "RENDERED"
    area.tag_redraw()
    yield from final("no picture came after Material Preview")
    seen = yield from compare("painted cubes", seen)
    # Another lens, then the view through the camera.
    bpy.data.cameras["Shot"].show_passepartout = False
    place.view_perspective = "ORTHO"
    area.tag_redraw()
    yield from final("no parallel picture came")
    seen = yield from compare("a parallel view", seen)
    place.view_perspective = "CAMERA"
    area.tag_redraw()
    yield from final("no picture came through the camera")
    seen = yield from compare("through the camera", seen)
    child = shown().child
    space.shading.type = "SOLID"
    area.tag_redraw()
    yield from until(lambda: child.process.poll() is not None, "the child outlives its view")
    expect(child.process.returncode == 0, "it ends by itself")
    expect(not thrown, f"nothing throws: {thrown}")


def failures():
    failed = claims.count(False)
    print(f"compare: {len(claims)} claims, {failed} failed", flush=True)
    return failed


run(test(), failures)

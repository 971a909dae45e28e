# SPDX-License-Identifier: Apache-2.0
"""The add-on in a 3D view of a Blender with a window: the view orbits, a lamp moves, a mesh is edited; what is shown in the end
is what the program renders of the whole scene, byte for byte, and it is what is on the screen. Run inside Blender:

    WINDOW=1 run.sh viewport.py ADDON.zip PENUMBRA WORK
"""

import os
import subprocess
import sys
import time
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import bpy  # noqa: E402
import numpy  # noqa: E402
from mathutils import Quaternion  # noqa: E402

import inside  # noqa: E402
import scenes  # noqa: E402

claims = []


def expect(claim, what):
    claims.append(bool(claim))
    if not claim:
        print(f"compare: FAILED: {what}", flush=True)


def out(name):
    return os.path.join(inside.OUT, name)


def space_of_view():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    return window, area, next(region for region in area.regions if region.type == "WINDOW"), area.spaces.active


def shown():
    from penumbra import viewport
    return next((view for view in viewport._views if view.child is not None), None)


def until(condition, what, seconds=120):
    """Blender goes on meanwhile."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            view = shown()
            raise TimeoutError(f"{what}; {view and view.status()}")
        yield 0.02


def final(what):
    """The final picture of what there is now."""
    for _ in range(5):  # Blender notices
        yield 0.02
    yield from until(lambda: shown() is not None and shown().is_final(), what)


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


def compare_with_screen(what):
    window, area, region, _ = space_of_view()
    bpy.ops.screen.screenshot(filepath=out("screen.png"))
    image = bpy.data.images.load(out("screen.png"))
    pixels = numpy.array(image.pixels, numpy.float32).reshape(image.size[1], image.size[0], 4)
    bpy.data.images.remove(image)
    part = pixels[region.y:region.y + region.height, region.x:region.x + region.width, :3]
    values = numpy.clip(shown().picture.rgba[::-1, :, :3] + (1 - shown().picture.rgba[::-1, :, 3:]) * 0.05, 0, 1)
    wanted = numpy.where(values < 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)
    off = numpy.abs(part - wanted).max(axis=-1)
    expect(float(numpy.median(off)) < 0.01, f"{what}: on the screen ({float(numpy.median(off)):.4f} off)")


def test():
    from penumbra import serving
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
    _, area, region, space = space_of_view()
    space.overlay.show_overlays = space.show_gizmo = space.show_region_header = False
    place = space.region_3d
    place.view_distance, place.view_location = 9, (0, 0, 0.5)
    place.view_rotation = Quaternion((0.82, 0.42, 0.17, 0.34))
    space.shading.type = "RENDERED"
    yield from final("no first picture came")
    compare_with_program("the first picture")
    for _ in range(5):
        yield 0.1
    compare_with_screen("the first picture")
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
    compare_with_program("an orbit")
    expect(len(pictures) > 2, f"pictures come meanwhile: {len(pictures)}")
    expect({head["type"] for head, _ in sent} == {"show"}, "nothing but the camera was sent")
    # A lamp moves.
    sent.clear()
    bpy.data.objects["Area"].location.x -= 1.5
    yield from final("no picture came after a lamp moved")
    compare_with_program("a lamp that moved")
    put = [data for head, data in sent if head["type"] == "put"]
    expect(put and all(b"Object/Area" in data and b"Block" not in data for data in put), "the lamp alone was sent")
    bpy.data.lights["Point"].energy *= 3
    yield from final("no picture came after a lamp was brightened")
    compare_with_program("a brighter lamp")
    # A mesh is edited, an object goes, another comes.
    sent.clear()
    mesh = bpy.data.objects["Block"].data
    for vertex in mesh.vertices:
        vertex.co.z *= 1.6
    mesh.update()
    yield from final("no picture came after a mesh was edited")
    compare_with_program("a mesh that was edited")
    put = [data for head, data in sent if head["type"] == "put"]
    expect(put and all(b"Object/Block" in data and b"Object/Area" not in data for data in put), "the mesh alone was sent")
    bpy.data.objects["Disk"].hide_set(True)
    scenes.add("Other", scenes.cube("Other"), (-1.5, 0.5, 0.7), (0, 0, 20))
    bpy.data.materials["Diffuse"].node_tree.nodes["Diffuse BSDF"].inputs["Color"].default_value = (0.2, 0.7, 0.3, 1)
    yield from final("no picture came after objects came and went")
    compare_with_program("objects that came and went")
    # Another lens, and through the camera.
    place.view_perspective = "ORTHO"
    area.tag_redraw()
    yield from final("no parallel picture came")
    compare_with_program("a parallel view")
    place.view_perspective = "CAMERA"
    area.tag_redraw()
    yield from final("no picture came through the camera")
    compare_with_program("through the camera")
    child = shown().child
    space.shading.type = "SOLID"
    area.tag_redraw()
    yield from until(lambda: child.process.poll() is not None, "the child outlives its view")
    expect(child.process.returncode == 0, "it ends by itself")


def step(running=test()):
    try:
        return next(running)
    except StopIteration:
        failed = claims.count(False)
    except BaseException:
        traceback.print_exc()
        print("compare: FAILED: it did not come to its end", flush=True)
        failed = 1
    print(f"compare: {len(claims)} claims, {failed} failed", flush=True)
    sys.stdout.flush()
    os._exit(1 if failed else 0)


bpy.app.timers.register(step, first_interval=0.5, persistent=True)  # the first step loads a file

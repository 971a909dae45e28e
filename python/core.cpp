// SPDX-License-Identifier: Apache-2.0
// Module penumbra._core: the library's classes for Python. Arrays of pictures are views that keep the picture alive;
// every long call releases the interpreter's lock and handles Ctrl-C. The interface for Python users is in __init__.py.

#include "python/own_method.hpp"

#include <penumbra/penumbra.hpp>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstring>
#include <tuple>
#include <utility>

namespace py = pybind11;
using namespace penumbra;

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Returns a message: names of files in it may have bytes that are not UTF-8, which become "\\xff".
py::str message(std::string_view text) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::list messages(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(message(text));
  return list;
}

/// Returns a file's name as Python's own functions give it.
py::str file_name(const std::filesystem::path& file) {
  PyObject* const decoded = PyUnicode_DecodeFSDefault(file.c_str());
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

std::vector<Vector> rows_of(const Doubles& array) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw UsageError("vertices: expected an array of shape (V, 3)");
  std::vector<Vector> rows(static_cast<std::size_t>(array.shape(0)));
  if (!rows.empty()) std::memcpy(rows.data(), array.data(), rows.size() * sizeof(Vector));
  return rows;
}

std::vector<std::array<std::uint32_t, 3>> faces_of(const Indices& array) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw UsageError("faces: expected an array of shape (F, 3)");
  std::vector<std::array<std::uint32_t, 3>> faces(static_cast<std::size_t>(array.shape(0)));
  const auto values = array.unchecked<2>();
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    for (py::ssize_t corner = 0; corner < 3; ++corner) {
      const std::int64_t vertex = values(i, corner);
      if (vertex < 0 || vertex > std::int64_t{0xffffffff})
        throw InputError("faces: row " + std::to_string(i) + " has vertex " + std::to_string(vertex));
      faces[static_cast<std::size_t>(i)][static_cast<std::size_t>(corner)] = static_cast<std::uint32_t>(vertex);
    }
  }
  return faces;
}

/// Returns a read-only array over a picture's memory; the array keeps the memory alive.
template <typename Value>
py::array view(const Picture& picture, std::span<const Value> values, std::vector<py::ssize_t> shape) {
  const py::capsule keeper(new Picture(picture), [](void* kept) { delete static_cast<Picture*>(kept); });
  py::array array;
  if constexpr (std::is_same_v<Value, Picture::Float3>) {
    shape.push_back(3);
    array = py::array_t<float>(shape, values.empty() ? nullptr : values.front().data(), keeper);
  } else {
    array = py::array_t<Value>(shape, values.data(), keeper);
  }
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <typename Value>
py::array pixels(const Picture& picture, std::span<const Value> values) {
  return view(picture, values, {picture.height(), picture.width()});
}

py::dict dict_of(const LightShape& shape) {
  struct Convert {
    py::dict operator()(const Rectangle& r) const {
      return py::dict(py::arg("kind") = "rectangle", py::arg("center") = r.center, py::arg("half_u") = r.half_u,
                      py::arg("half_v") = r.half_v);
    }
    py::dict operator()(const Disk& d) const {
      return py::dict(py::arg("kind") = "disk", py::arg("center") = d.center, py::arg("normal") = d.normal,
                      py::arg("radius") = d.radius);
    }
    py::dict operator()(const Ellipse& e) const {
      return py::dict(py::arg("kind") = "ellipse", py::arg("center") = e.center, py::arg("half_u") = e.half_u,
                      py::arg("half_v") = e.half_v);
    }
    py::dict operator()(const Polygon& p) const {
      return py::dict(py::arg("kind") = "polygon", py::arg("vertices") = p.vertices);
    }
    py::dict operator()(const Sphere& s) const {
      return py::dict(py::arg("kind") = "sphere", py::arg("center") = s.center, py::arg("radius") = s.radius);
    }
    py::dict operator()(const Sun& s) const {
      return py::dict(py::arg("kind") = "sun", py::arg("direction") = s.direction, py::arg("angle") = s.angle);
    }
    py::dict operator()(const Dome& d) const {
      return py::dict(py::arg("kind") = "dome", py::arg("up") = d.up, py::arg("rotate") = d.rotate,
                      py::arg("half") = d.half, py::arg("image") = file_name(d.image), py::arg("sampled") = d.sampled);
    }
  };
  return std::visit(Convert(), shape);
}

/// Returns the value of a required key. Throws UsageError, with the expected type, if it is missing or wrong.
template <typename Value>
Value wanted(const py::dict& dict, const char* key) {
  if (!dict.contains(key)) throw UsageError(std::string("a light of this kind needs ") + key);
  try {
    return dict[key].cast<Value>();
  } catch (const py::cast_error&) {
    throw UsageError(std::string("light: ") + key +
                     " is not what it should be: " + py::repr(dict[key]).cast<std::string>());
  }
}

LightShape shape_of(const std::string& kind, const py::dict& d) {
  if (kind == "rectangle")
    return Rectangle{wanted<Vector>(d, "center"), wanted<Vector>(d, "half_u"), wanted<Vector>(d, "half_v")};
  if (kind == "disk")
    return Disk{wanted<Vector>(d, "center"), wanted<Vector>(d, "normal"), wanted<double>(d, "radius")};
  if (kind == "ellipse")
    return Ellipse{wanted<Vector>(d, "center"), wanted<Vector>(d, "half_u"), wanted<Vector>(d, "half_v")};
  if (kind == "polygon") return Polygon{wanted<std::vector<Vector>>(d, "vertices")};
  if (kind == "sphere") return Sphere{wanted<Vector>(d, "center"), wanted<double>(d, "radius")};
  if (kind == "sun") return Sun{wanted<Vector>(d, "direction"), wanted<double>(d, "angle")};
  if (kind == "dome") {
    Dome dome;
    if (d.contains("up")) dome.up = wanted<Vector>(d, "up");
    if (d.contains("rotate")) dome.rotate = wanted<double>(d, "rotate");
    if (d.contains("half")) dome.half = wanted<bool>(d, "half");
    if (d.contains("image")) dome.image = wanted<std::filesystem::path>(d, "image");
    if (d.contains("sampled")) dome.sampled = wanted<bool>(d, "sampled");
    return dome;
  }
  throw UsageError("light of kind \"" + kind + "\": expected rectangle, disk, ellipse, polygon, sphere, sun or dome");
}

Matrix matrix_of(const Doubles& matrix) {
  if (matrix.size() != 16) throw UsageError("matrix: expected 4x4 numbers");
  Matrix m{};
  std::memcpy(m.data(), matrix.data(), sizeof(m));
  return m;
}

/// Returns options that call the calling program's functions with the interpreter's lock held; Ctrl-C ends the call.
RendererOptions options_of(std::string device, py::object log, py::object progress) {
  RendererOptions options;
  options.device = std::move(device);
  if (!log.is_none()) {
    options.log = [log = std::move(log)](LogLevel level, std::string_view text) {
      constexpr std::array kNames = {"debug", "info", "warning", "error"};
      const py::gil_scoped_acquire locked;
      log(kNames.at(static_cast<std::size_t>(level)), message(text));
    };
  }
  options.progress = [progress = std::move(progress)](std::string_view stage, double done) {
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress.is_none()) return true;
    const py::object answer = progress(std::string(stage), done);
    const int is_true = PyObject_IsTrue(answer.ptr());
    if (is_true < 0) throw py::error_already_set();
    return answer.is_none() || is_true == 1;
  };
  return options;
}

/// Returns a progress function by which Ctrl-C ends the call.
std::function<bool(std::string_view, double)> ends_on_signals() {
  return options_of({}, py::none(), py::none()).progress;
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  static const py::exception<Error> error(module, "Error", PyExc_RuntimeError);
  static const py::exception<UsageError> usage(module, "UsageError", error.ptr());
  static const py::exception<InputError> input(module, "InputError", error.ptr());
  static const py::exception<ResourceError> resource(module, "ResourceError", error.ptr());
  static const py::exception<Cancelled> cancelled(module, "Cancelled", error.ptr());
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const UsageError& e) {
      PyErr_SetObject(usage.ptr(), message(e.what()).ptr());
    } catch (const InputError& e) {
      PyErr_SetObject(input.ptr(), message(e.what()).ptr());
    } catch (const ResourceError& e) {
      PyErr_SetObject(resource.ptr(), message(e.what()).ptr());
    } catch (const Cancelled& e) {
      PyErr_SetObject(cancelled.ptr(), message(e.what()).ptr());
    } catch (const Error& e) {
      PyErr_SetObject(error.ptr(), message(e.what()).ptr());
    }
  });
  using Unlocked = py::call_guard<py::gil_scoped_release>;

  py::class_<Scene>(module, "Scene")
      .def(py::init<>())
      .def(py::init<const Scene&>())
      .def_static("load",
                  [](const std::filesystem::path& file, bool lenient, bool allow_outside, std::optional<double> frame,
                     double fps, std::optional<double> lamp_radius, std::optional<double> sun_angle,
                     std::optional<double> lumens_per_watt, std::vector<std::string> clips, bool studio) {
                    const LoadOptions options{
                        lenient,         allow_outside,    frame,  fps, lamp_radius,      sun_angle,
                        lumens_per_watt, std::move(clips), studio, {},  ends_on_signals()};
                    const py::gil_scoped_release unlocked;
                    return Scene::load(file, options);
                  })
      .def_static("parse",
                  [](const std::string& json, const std::filesystem::path& folder, bool allow_outside,
                     const std::vector<std::tuple<std::uint32_t, Doubles, Indices>>& arrays) {
                    std::vector<std::vector<Vector>> rows;
                    std::vector<std::vector<std::array<std::uint32_t, 3>>> faces;
                    std::vector<MeshArrays> given;
                    for (const auto& [mesh, vertices, triangles] : arrays) {
                      rows.push_back(rows_of(vertices));
                      faces.push_back(faces_of(triangles));
                      given.push_back({mesh, rows.back(), faces.back()});
                    }
                    LoadOptions options;
                    options.allow_outside = allow_outside;
                    options.arrays = given;
                    options.progress = ends_on_signals();
                    const py::gil_scoped_release unlocked;
                    return Scene::parse(json, folder, options);
                  })
      .def("add_mesh",
           [](Scene& scene, std::string name, const Doubles& vertices, const Indices& faces, const Vector& color,
              bool casts_shadow, bool receives_shadow) {
             return scene
                 .add_mesh(std::move(name), rows_of(vertices), faces_of(faces), {color, casts_shadow, receives_shadow})
                 .index;
           })
      .def("set_mesh", [](Scene& scene, std::uint32_t mesh, const Doubles& vertices,
                          const Indices& faces) { scene.set_mesh({mesh}, rows_of(vertices), faces_of(faces)); })
      .def("set_positions", [](Scene& scene, std::uint32_t mesh,
                               const Doubles& vertices) { scene.set_positions({mesh}, rows_of(vertices)); })
      .def("set_transform", [](Scene& scene, std::uint32_t mesh,
                               const Doubles& matrix) { scene.set_transform(MeshId{mesh}, matrix_of(matrix)); })
      .def("add_instance", [](Scene& scene, std::uint32_t mesh,
                              const Doubles& matrix) { return scene.add_instance({mesh}, matrix_of(matrix)).number; })
      .def("set_instance_transform",
           [](Scene& scene, std::uint32_t mesh, std::uint32_t number, const Doubles& matrix) {
             scene.set_transform(InstanceId{{mesh}, number}, matrix_of(matrix));
           })
      .def("instance_count", [](const Scene& scene, std::uint32_t mesh) { return scene.instance_count({mesh}); })
      .def("mesh", [](const Scene& scene, const std::string& name) { return scene.mesh(name).index; })
      .def("mesh_names",
           [](const Scene& scene) {
             std::vector<std::string> names;
             for (std::uint32_t i = 0; i < scene.mesh_count(); ++i) names.push_back(scene.mesh_name({i}));
             return names;
           })
      .def("add_light",
           [](Scene& scene, std::string name, const std::string& kind, const py::dict& shape, const Vector& radiance,
              bool two_sided) {
             scene.add_light(std::move(name), shape_of(kind, shape), {radiance, two_sided});
           })
      .def("set_light_shape", [](Scene& scene, const std::string& name, const std::string& kind,
                                 const py::dict& shape) { scene.set_light(name, shape_of(kind, shape)); })
      .def("set_light_options",
           [](Scene& scene, const std::string& name, const Vector& radiance, bool two_sided) {
             scene.set_light(name, LightOptions{radiance, two_sided});
           })
      .def("remove_light", [](Scene& scene, const std::string& name) { scene.remove_light(name); })
      .def("light",
           [](const Scene& scene, const std::string& name) {
             const LightOptions options = scene.light_options(name);
             const std::optional<LightShape> shape = scene.light_shape(name);
             py::dict light = shape ? dict_of(*shape) : py::dict(py::arg("kind") = "pieces");
             light["radiance"] = options.radiance;
             light["two_sided"] = options.two_sided;
             return light;
           })
      .def("light_names", &Scene::lights)
      .def("set_camera",
           [](Scene& scene, const Vector& eye, const Vector& target, const Vector& up, double vertical_fov,
              std::optional<double> height, std::string name, double aperture, double focus_distance) {
             scene.set_camera({eye, target, up, vertical_fov, height, std::move(name), aperture, focus_distance});
           })
      .def("camera_names",
           [](const Scene& scene) {
             std::vector<std::string> names;
             for (const Camera& camera : scene.cameras()) names.push_back(camera.name);
             return names;
           })
      .def("triangle_count", &Scene::triangle_count)
      .def("size", &Scene::size)
      .def("set_size", &Scene::set_size)
      .def("warnings", [](const Scene& scene) { return messages(scene.warnings()); })
      .def("save", [](const Scene& scene, const std::filesystem::path& file) {
        std::vector<std::string> warnings;
        {
          const py::gil_scoped_release unlocked;
          warnings = scene.save(file);
        }
        return messages(warnings);
      });

  py::class_<Picture>(module, "Picture")
      .def("width", &Picture::width)
      .def("height", &Picture::height)
      .def("light_names", &Picture::lights)
      .def("visibility", [](const Picture& p, std::size_t light) { return pixels(p, p.visibility(light)); })
      .def("beauty", [](const Picture& p) { return pixels(p, p.beauty()); })
      .def("light_beauty", [](const Picture& p, std::size_t light) { return pixels(p, p.beauty(light)); })
      .def("alpha", [](const Picture& p) { return pixels(p, p.alpha()); })
      .def("positions", [](const Picture& p) { return pixels(p, p.positions()); })
      .def("relative_positions", [](const Picture& p) { return pixels(p, p.relative_positions()); })
      .def("normals", [](const Picture& p) { return pixels(p, p.normals()); })
      .def("depth", [](const Picture& p) { return pixels(p, p.depth()); })
      .def("ids", [](const Picture& p) { return pixels(p, p.ids()); })
      .def("origin", &Picture::origin)
      .def("mask_words",
           [](const Picture& p, std::size_t light) -> py::object {
             const std::span<const std::uint32_t> words = p.masks(light);
             if (words.empty()) return py::none();
             return view(p, words, {p.height(), p.width(), static_cast<py::ssize_t>(p.words_per_mask(light))});
           })
      .def("light_samples", &Picture::light_samples)
      .def("method", &Picture::method)
      .def("stats_json", &Picture::stats_json);

  py::class_<Renderer>(module, "Renderer")
      .def(py::init([](const Scene& scene, std::string device, py::object log, py::object progress) {
        return Renderer(scene, options_of(std::move(device), std::move(log), std::move(progress)));
      }))
      .def("scene", py::overload_cast<>(&Renderer::scene), py::return_value_policy::reference_internal)
      .def(
          "render",
          [](Renderer& renderer, std::uint32_t width, std::uint32_t height, std::string method,
             std::map<std::string, std::string> options, std::uint32_t light_samples, std::string sample_pattern,
             std::uint32_t sample_seed, std::vector<std::string> lights, std::string camera,
             std::uint32_t pixel_samples, double pixel_tolerance, double light_cutoff, bool shading_normals, bool masks,
             std::string instances) {
            return renderer.render({width, height, std::move(method), std::move(options), light_samples,
                                    std::move(sample_pattern), sample_seed, std::move(lights), std::move(camera),
                                    pixel_samples, pixel_tolerance, light_cutoff, shading_normals, masks,
                                    std::move(instances)});
          },
          Unlocked());

  module.def(
      "compare_json",
      [](const Scene& scene, std::vector<std::string> methods, std::string reference, std::string reference_samples,
         std::uint32_t width, std::uint32_t height, std::uint32_t light_samples, std::string sample_pattern,
         std::vector<std::string> lights, std::string camera, std::uint32_t runs, bool error_budget,
         const std::filesystem::path& out, std::string device, py::object log, py::object progress) {
        const RendererOptions renderer = options_of(std::move(device), std::move(log), std::move(progress));
        const CompareOptions options{std::move(methods),
                                     std::move(reference),
                                     std::move(reference_samples),
                                     width,
                                     height,
                                     light_samples,
                                     std::move(sample_pattern),
                                     std::move(lights),
                                     std::move(camera),
                                     runs,
                                     error_budget,
                                     out};
        const py::gil_scoped_release unlocked;
        return compare_json(scene, options, renderer);
      });
  module.def("inspect_file", [](const std::filesystem::path& file, double weld, bool self_intersections,
                                std::size_t list_limit, py::object log, py::object progress) {
    const RendererOptions host = options_of({}, std::move(log), std::move(progress));
    const py::gil_scoped_release unlocked;
    return inspect_json(file, {weld, self_intersections, list_limit}, host);
  });
  module.def("inspect_arrays", [](const Doubles& vertices, const Indices& faces, double weld, bool self_intersections,
                                  std::size_t list_limit, py::object log, py::object progress) {
    const auto positions = rows_of(vertices);
    const auto triangles = faces_of(faces);
    const RendererOptions host = options_of({}, std::move(log), std::move(progress));
    const py::gil_scoped_release unlocked;
    return inspect_json(positions, triangles, {weld, self_intersections, list_limit}, host);
  });
  module.def("wedges_json", [](const Scene& scene, std::string light, std::string construction, std::string from,
                               bool validate) {
    const WedgeOptions options{std::move(light), std::move(construction), std::move(from), validate, ends_on_signals()};
    const py::gil_scoped_release unlocked;
    return wedges_json(scene, options);
  });
  define_own_methods(module);
  module.def("methods_json", &methods_json);
  module.def("version", &version);
}

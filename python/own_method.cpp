// SPDX-License-Identifier: Apache-2.0
// Shadow methods implemented by Python functions: called with arrays, returning an array. The interpreter's lock is
// taken for each call, since the library runs without the lock.

#include "python/own_method.hpp"

#include <penumbra/penumbra.hpp>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstring>
#include <type_traits>
#include <utility>

namespace py = pybind11;

namespace penumbra {
namespace {

/// Returns a copy: a method may keep the array.
template <typename Value>
py::array copied(std::span<const Value> values) {
  if constexpr (std::is_arithmetic_v<Value>) {
    return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
  } else {
    using Number = typename Value::value_type;
    return py::array_t<Number>({static_cast<py::ssize_t>(values.size()), static_cast<py::ssize_t>(3)},
                               values.empty() ? nullptr : values.front().data());
  }
}

/// Method whose results come from a Python function.
class PythonMethod final : public OwnMethod {
 public:
  PythonMethod(const py::object& function, bool has_masks, const std::map<std::string, std::string>& options)
      : function_(function), has_masks_(has_masks) {
    const py::gil_scoped_acquire locked;
    question_ = new py::dict();
    (*question_)["options"] = options;
  }
  PythonMethod(const PythonMethod&) = delete;
  PythonMethod& operator=(const PythonMethod&) = delete;
  ~PythonMethod() override {
    const py::gil_scoped_acquire locked;
    delete question_;
  }

  void set_scene(const MethodScene& scene) override {
    const py::gil_scoped_acquire locked;
    py::dict& q = *question_;
    q["origin"] = scene.origin;
    q["vertices"] = copied(scene.positions);
    q["faces"] = copied(scene.triangles);
    q["casts"] = copied(scene.casts).attr("astype")("bool");
  }
  void set_light(const MethodLight& light) override {
    const py::gil_scoped_acquire locked;
    light_ = light;
    (*question_)["light"] =
        py::dict(py::arg("name") = light.name, py::arg("kind") = light.kind, py::arg("center") = light.center,
                 py::arg("u") = light.u, py::arg("v") = light.v, py::arg("radius") = light.radius,
                 py::arg("two_sided") = light.two_sided, py::arg("outline") = copied(light.outline),
                 py::arg("points") = copied(light.points), py::arg("weights") = copied(light.weights));
  }
  void set_view(const MethodView& view) override {
    const py::gil_scoped_acquire locked;
    view_ = view;
    py::dict& q = *question_;
    const py::tuple shape = py::make_tuple(view.height, view.width);
    q["size"] = py::make_tuple(view.width, view.height);
    q["all_p"] = copied(view.p).attr("reshape")(view.height, view.width, 3);
    q["all_n"] = copied(view.n).attr("reshape")(view.height, view.width, 3);
    q["all_faces"] = copied(view.triangle).attr("reshape")(shape);
  }

  void visibility(std::span<const std::uint32_t> pixels, std::span<float> visibility) override {
    const py::gil_scoped_acquire locked;
    const py::array_t<float, py::array::c_style | py::array::forcecast> answer(ask(pixels));
    if (answer.ndim() != 1 || static_cast<std::size_t>(answer.size()) != pixels.size())
      throw UsageError("a method's function: expected V as an array of shape (" + std::to_string(pixels.size()) + ",)");
    std::memcpy(visibility.data(), answer.data(), visibility.size_bytes());
  }
  void masks(std::span<const std::uint32_t> pixels, std::span<std::uint32_t> masks) override {
    const py::gil_scoped_acquire locked;
    const py::array_t<bool, py::array::c_style | py::array::forcecast> answer(ask(pixels));
    if (answer.ndim() != 2 || static_cast<std::size_t>(answer.shape(0)) != pixels.size() ||
        static_cast<std::size_t>(answer.shape(1)) != light_.light_samples)
      throw UsageError("a method's function: expected masks as an array of shape (" + std::to_string(pixels.size()) +
                       ", " + std::to_string(light_.light_samples) + ")");
    const auto values = answer.unchecked<2>();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      for (std::uint32_t j = 0; j < light_.light_samples; ++j) {
        if (values(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(j)))
          masks[i * light_.words_per_mask + j / 32] |= 1U << (j % 32);
      }
    }
  }

 private:
  py::object ask(std::span<const std::uint32_t> pixels) {
    py::dict& q = *question_;
    const py::ssize_t count = static_cast<py::ssize_t>(pixels.size());
    // a sphere's light samples: different for each pixel
    const std::size_t samples = light_.points.empty() ? light_.light_samples : 0;
    py::array_t<float> p({count, py::ssize_t{3}}), n({count, py::ssize_t{3}});
    py::array_t<std::int32_t> face(count);
    py::array_t<float> points({samples == 0 ? 0 : count, static_cast<py::ssize_t>(samples), py::ssize_t{3}});
    std::vector<Float3> own_points(samples);
    for (py::ssize_t i = 0; i < count; ++i) {
      const std::uint32_t pixel = pixels[static_cast<std::size_t>(i)];
      std::memcpy(p.mutable_data(i, 0), view_.p[pixel].data(), sizeof(Float3));
      std::memcpy(n.mutable_data(i, 0), view_.n[pixel].data(), sizeof(Float3));
      *face.mutable_data(i) = view_.triangle[pixel];
      if (samples == 0) continue;
      light_.points_for(view_.p[pixel], own_points);
      std::memcpy(points.mutable_data(i, 0, 0), own_points.data(), samples * sizeof(Float3));
    }
    q["pixels"] = copied(pixels);
    q["p"] = p;
    q["n"] = n;
    q["face"] = face;
    q["points_of_pixel"] = samples == 0 ? py::object(py::none()) : py::object(points);
    q["masks"] = has_masks_;
    return function_(q);
  }

  const py::object& function_;  // never freed
  bool has_masks_;
  py::dict* question_ = nullptr;
  MethodLight light_;
  MethodView view_;
};

}  // namespace

void define_own_methods(py::module_& module) {
  module.def("add_method", [](std::string name, const py::object& function, std::string family, std::string paper,
                              std::string exact_for, bool masks, std::vector<std::string> lights, bool textures,
                              const std::vector<py::dict>& options) {
    OwnMethodInfo info{.name = std::move(name),
                       .family = std::move(family),
                       .paper = std::move(paper),
                       .exact_for = std::move(exact_for),
                       .masks = masks,
                       .lights = std::move(lights),
                       .textures = textures};
    for (const py::dict& option : options) {
      info.options.push_back({.name = option["name"].cast<std::string>(),
                              .default_value = option["default"].cast<std::string>(),
                              .help = {},
                              .choices = option["choices"].cast<std::vector<std::string>>(),
                              .least = option["least"].cast<double>(),
                              .most = option["most"].cast<double>(),
                              .whole = option["whole"].cast<bool>()});
    }
    // Never freed: methods stay until the process ends, after the interpreter.
    const auto* const kept = new py::object(function);
    add_method(info, [kept, masks](const std::map<std::string, std::string>& values) {
      return std::make_unique<PythonMethod>(*kept, masks, values);
    });
  });
}

}  // namespace penumbra

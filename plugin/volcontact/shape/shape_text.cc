// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/shape_text.h"

#include <type_traits>

namespace volcontact {
namespace {

constexpr int kMostNumbers = 100000000;
constexpr const char* kOperations[] = {"union", "intersection", "difference"};

void append_count(std::size_t count, std::string& text) {
  text += ' ';
  text += std::to_string(count);
}

void append_points(const std::vector<Vec3>& points, std::string& text) {
  append_count(points.size(), text);
  for (const Vec3& point : points) {
    for (const double x : point) append_number(x, text);
  }
}

std::vector<Vec3> read_points(TextReader& reader) {
  const int count = reader.count("the count of points", kMostNumbers);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3& point = points.emplace_back();
    for (double& x : point) x = reader.number("a coordinate");
  }
  return points;
}

template <typename S>
void append_solid(const S& solid, std::string& text) {
  text += S::kName;
  if constexpr (std::is_same_v<S, SignedDistance>) {
    require(false,
            "a signed distance is code and cannot be written as text; compose the solid of shapes "
            "or give a mesh");
  } else if constexpr (requires { solid.params(); }) {
    for (const auto& field : S::kFields) {
      for (int i = 0; i < field.size(); ++i) append_number(field.get(solid.params(), i), text);
    }
  } else if constexpr (std::is_same_v<S, ConvexPolytope>) {
    append_points(solid.vertices(), text);
  } else if constexpr (std::is_same_v<S, Mesh>) {
    append_points(solid.topology().vertices, text);
    append_count(solid.topology().triangles.size(), text);
    for (const Triangle& triangle : solid.topology().triangles) {
      for (const int corner : triangle) append_count(static_cast<std::size_t>(corner), text);
    }
  } else if constexpr (std::is_same_v<S, Csg>) {
    // In postfix order, as the solid keeps it.
    append_count(solid.steps().size(), text);
    for (const Csg::Step& step : solid.steps()) {
      if (step.member < 0) {
        text += ' ';
        text += kOperations[static_cast<int>(step.operation)];
        continue;
      }
      const Csg::Member& member = solid.members()[static_cast<std::size_t>(step.member)];
      text += " member";
      append_pose(member.X_SM, text);
      text += " ";
      std::visit([&](const auto& shape) { append_solid(shape, text); }, member.shape);
    }
  } else {
    static_assert(std::is_same_v<S, HalfSpace>);
  }
}

Mesh read_mesh(TextReader& reader) {
  const std::vector<Vec3> vertices = read_points(reader);
  const int count = reader.count("the count of triangles", kMostNumbers);
  const int last = static_cast<int>(vertices.size()) - 1;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    Triangle& triangle = triangles.emplace_back();
    for (int& corner : triangle) corner = reader.count("the index of a vertex", last);
  }
  return Mesh(vertices, triangles);
}

Csg read_csg(TextReader& reader) {
  const int steps = reader.count("the count of steps", 2 * Csg::kMostMembers);
  std::vector<Csg> waiting;
  for (int i = 0; i < steps; ++i) {
    const std::string_view word = reader.word("member or an operation");
    if (word == "member") {
      const Pose X_SM = read_pose(reader);
      waiting.push_back(composed(read_shape(reader)).posed(X_SM));
      continue;
    }
    int operation = 0;
    while (operation < 3 && word != kOperations[operation]) ++operation;
    require(operation < 3 && waiting.size() >= 2,
            reader.where() + "'" + std::string(word) + "' is no step of a composed solid here");
    const Csg b = waiting.back();
    waiting.pop_back();
    waiting.back() = Csg(static_cast<Csg::Operation>(operation), waiting.back(), b);
  }
  require(waiting.size() == 1, reader.where() + "the composed solid is not complete");
  waiting[0].prepare();  // what is worked out once, before threads share it
  return waiting[0];
}

template <typename S>
bool read_simple(std::string_view name, TextReader& reader, Shape& out) {
  if constexpr (requires { S::kFields; }) {
    if (name != S::kName) return false;
    typename S::Params params{};
    for (const auto& field : S::kFields) {
      for (int i = 0; i < field.size(); ++i) field.set(params, i, reader.number(field.name));
    }
    out = S(params);
    return true;
  }
  return false;
}

}  // namespace

void append_pose(const Pose& pose, std::string& text) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) append_number(pose.rotation(i, k), text);
    append_number(pose.translation[i], text);
  }
  text += " 0 0 0 1";
}

Pose read_pose(TextReader& reader) {
  double m[16];
  for (double& number : m) number = reader.number("a number of a pose");
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) pose.rotation(i, k) = m[4 * i + k];
    pose.translation[i] = m[4 * i + 3];
  }
  const Mat3 skewed = pose.rotation.transpose() * pose.rotation - Mat3::Identity();
  require(pose.is_finite() && skewed.norm() < 1e-6 && pose.rotation.determinant() > 0.0,
          reader.where() + "the 16 numbers are no pose: a rotation, a position, then 0 0 0 1");
  return pose;
}

std::string text_of(const Shape& shape) {
  std::string text;
  std::visit([&](const auto& solid) { append_solid(solid, text); }, shape);
  return text;
}

Shape read_shape(TextReader& reader) {
  const std::string_view name = reader.word("the name of a shape");
  if (name == Mesh::kName) return read_mesh(reader);
  if (name == ConvexPolytope::kName) return ConvexPolytope(read_points(reader));
  if (name == Csg::kName) return read_csg(reader);
  Shape shape;
  bool found = false;
  for_each_type(SimpleShapes{}, [&]<typename Tag>(Tag) {
    found = found || read_simple<typename Tag::Type>(name, reader, shape);
  });
  require(found, reader.where() + "'" + std::string(name) + "' is no shape that text has");
  return shape;
}

}  // namespace volcontact

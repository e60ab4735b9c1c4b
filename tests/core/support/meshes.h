// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/support/random.h"
#include "volcontact/shape/mesh/mesh.h"

namespace volcontact::test {

/// Triangles of a surface, counterclockwise seen from outside.
struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  Soup moved(const Pose& X) const {
    Soup soup = *this;
    for (Vec3& v : soup.vertices) v = X * v;
    return soup;
  }
  Soup inside_out() const {
    Soup soup = *this;
    for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
    return soup;
  }
  Soup with(const Soup& other) const {
    Soup soup = *this;
    const int offset = static_cast<int>(vertices.size());
    soup.vertices.insert(soup.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Triangle& t : other.triangles) {
      soup.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    return soup;
  }
};

inline Mesh mesh_of(const Soup& soup) { return {soup.vertices, soup.triangles}; }
inline Pose shifted(double x, double y, double z) { return {Mat3::Identity(), Vec3(x, y, z)}; }

/// A box with n x n squares on each face, cut into triangles; its vertices are not welded.
inline Soup box_soup(const Vec3& half, int n = 1) {
  Soup soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const int first = static_cast<int>(soup.vertices.size());
          for (int corner = 0; corner < 4; ++corner) {
            Vec3 p;
            p[axis] = sign;
            p[(axis + 1) % 3] = -1.0 + 2.0 * (i + (corner & 1)) / n;
            p[(axis + 2) % 3] = -1.0 + 2.0 * (j + (corner >> 1)) / n;
            soup.vertices.push_back(p.cwiseProduct(half));
          }
          const bool up = sign > 0.0;
          soup.triangles.push_back({first, first + (up ? 1 : 2), first + (up ? 2 : 1)});
          soup.triangles.push_back({first + 3, first + (up ? 2 : 1), first + (up ? 1 : 2)});
        }
      }
    }
  }
  return soup;
}

/// A ball of radius 1 with 20 * 4^levels triangles.
inline Soup ball_soup(int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Soup soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (double a : {-1.0, 1.0}) {
      for (double b : {-g, g}) {
        Vec3 p = Vec3::Zero();
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        soup.vertices.push_back(p.normalized());
      }
    }
  }
  // Neighbours are nearest to each other; every triple of them is a face.
  const double edge = 1.1 * 2.0 / std::sqrt(1.0 + g * g);
  const auto near = [&](int i, int j) {
    return (soup.vertices[i] - soup.vertices[j]).norm() < edge;
  };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!near(i, j) || !near(j, k) || !near(k, i)) continue;
        const Vec3 &a = soup.vertices[i], &b = soup.vertices[j], &c = soup.vertices[k];
        const bool outward = a.dot(b.cross(c)) > 0.0;
        soup.triangles.push_back(outward ? Triangle{i, j, k} : Triangle{i, k, j});
      }
    }
  }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int i, int j) {
      const auto [entry, is_new] =
          middles.emplace(std::minmax(i, j), static_cast<int>(soup.vertices.size()));
      if (is_new) soup.vertices.push_back((soup.vertices[i] + soup.vertices[j]).normalized());
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : soup.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    soup.triangles = std::move(finer);
  }
  return soup;
}

/// A ball of about radius 1 with bumps and hollows: not convex.
inline Soup bumpy_soup(int levels, int seed) {
  Soup soup = ball_soup(levels);
  Random random(seed);
  const Vec3 phase = random.in_box(3.0);
  for (Vec3& p : soup.vertices) {
    const Vec3 angles = 9.0 * p + phase;
    p *= 1.0 + 0.03 * (std::sin(angles.x()) + std::sin(angles.y()) + std::sin(angles.z()));
  }
  return soup;
}

/// A prism-shaped ring around z: n sides, inner and outer radius (of the corners), half height.
inline Soup ring_soup(double inner, double outer, double half, int n) {
  Soup soup;
  for (double radius : {inner, outer}) {
    for (double z : {-half, half}) {
      for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * kPi * i / n;
        soup.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    const auto add = [&](int a, int b, int c, int d) {  // a quadrangle
      soup.triangles.push_back({a, b, c});
      soup.triangles.push_back({a, c, d});
    };
    add(n + i, n + j, j, i);                          // the bore
    add(2 * n + i, 2 * n + j, 3 * n + j, 3 * n + i);  // outside
    add(i, j, 2 * n + j, 2 * n + i);                  // bottom
    add(3 * n + i, 3 * n + j, n + j, n + i);          // top
  }
  return soup;
}

/// A prism along z over a polygon, counterclockwise; `cuts` are the triangles that it consists of.
inline Soup prism_soup(const std::vector<Vec2>& polygon, const std::vector<Triangle>& cuts,
                       double half) {
  const int n = static_cast<int>(polygon.size());
  Soup soup;
  for (double z : {-half, half}) {
    for (const Vec2& p : polygon) soup.vertices.emplace_back(p.x(), p.y(), z);
  }
  for (const Triangle& t : cuts) {
    soup.triangles.push_back({t[0], t[2], t[1]});
    soup.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    soup.triangles.push_back({i, j, n + j});
    soup.triangles.push_back({i, n + j, n + i});
  }
  return soup;
}

/// A regular one with this many sides, its corners `radius` away from z; one is on x.
inline Soup regular_prism_soup(int sides, double radius, double half) {
  std::vector<Vec2> polygon;
  std::vector<Triangle> cuts;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * kPi * i / sides;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    if (i >= 2) cuts.push_back({0, i - 1, i});
  }
  return prism_soup(polygon, cuts, half);
}

/// A channel along z, open towards y: 6 wide, 5 high, its walls 1 thick, as everything by `unit`;
/// around its middle. It is made of three boxes.
inline Soup channel_soup(double unit, double half) {
  std::vector<Vec2> outline;
  for (const auto& [x, y] : {std::pair(-3.0, -2.5),
                             {3.0, -2.5},
                             {3.0, 2.5},
                             {2.0, 2.5},
                             {2.0, -1.5},
                             {-2.0, -1.5},
                             {-2.0, 2.5},
                             {-3.0, 2.5}}) {
    outline.emplace_back(unit * x, unit * y);
  }
  return prism_soup(outline, {{0, 1, 5}, {1, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 7}, {5, 6, 7}},
                    half);
}
inline std::vector<std::pair<Vec3, Vec3>> channel_boxes(double unit, double half) {
  return {{unit * Vec3(0.0, -2.0, 0.0), Vec3(3.0 * unit, 0.5 * unit, half)},
          {unit * Vec3(-2.5, 0.5, 0.0), Vec3(0.5 * unit, 2.0 * unit, half)},
          {unit * Vec3(2.5, 0.5, 0.0), Vec3(0.5 * unit, 2.0 * unit, half)}};
}

}  // namespace volcontact::test

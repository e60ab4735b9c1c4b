// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace volcontact {
namespace {

using Spans = std::vector<RayInterval>;

// Real roots of c[0] + c[1] t + ... + c[n] t^n in ascending order: between those of the derivative.
std::vector<double> roots(const std::vector<double>& c) {
  const std::size_t n = c.size() - 1;
  if (n == 0) return {};
  if (c[n] == 0.0) return roots({c.begin(), c.end() - 1});
  if (n == 1) return {-c[0] / c[1]};
  const auto value = [&c](double t) {
    double sum = 0.0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * t + c[i];
    return sum;
  };
  std::vector<double> slopes;
  for (std::size_t i = 1; i <= n; ++i) slopes.push_back(static_cast<double>(i) * c[i]);
  double bound = 0.0;  // Cauchy's, of all roots
  for (std::size_t i = 0; i < n; ++i) bound = std::max(bound, std::abs(c[i] / c[n]));
  std::vector<double> ends = roots(slopes);
  ends.insert(ends.begin(), -1.0 - bound);
  ends.push_back(1.0 + bound);
  std::vector<double> found;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    double low = ends[i], high = ends[i + 1];
    const bool rising = value(high) > value(low);
    if (value(low) * value(high) > 0.0) continue;
    for (int k = 0; k < 200 && low < high; ++k) {
      const double middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      ((value(middle) < 0.0) == rising ? low : high) = middle;
    }
    found.push_back(0.5 * (low + high));
  }
  return found;
}

// (|x|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2) along the line, t from the point nearest the middle.
void torus_line(const Torus& torus, const Vec3& o, const Vec3& d, Spans& spans) {
  const double R = torus.major_radius(), r = torus.minor_radius();
  const double shift = -o.dot(d) / d.squaredNorm();
  const Vec3 p = o + shift * d;
  const double dd = d.squaredNorm(), pd = p.dot(d), k = p.squaredNorm() + R * R - r * r;
  const double dd2 = d.x() * d.x() + d.y() * d.y(), pd2 = p.x() * d.x() + p.y() * d.y(),
               pp2 = p.x() * p.x() + p.y() * p.y();
  const std::vector<double> all =
      roots({k * k - 4.0 * R * R * pp2, 4.0 * pd * k - 8.0 * R * R * pd2,
             4.0 * pd * pd + 2.0 * dd * k - 4.0 * R * R * dd2, 4.0 * pd * dd, dd * dd});
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const double middle = shift + 0.5 * (all[i] + all[i + 1]);
    if (torus.signed_distance(o + middle * d) < 0.0) {
      spans.push_back({shift + all[i], shift + all[i + 1]});
    }
  }
}

void member_line(const Csg::Member& member, const Vec3& o, const Vec3& d, Spans& spans) {
  const Vec3 o_M = member.X_MS * o, d_M = member.X_MS.rotation * d;
  std::visit(
      [&](const auto& shape) {
        if constexpr (ConvexSolid<std::decay_t<decltype(shape)>>) {
          const RayInterval span = shape.ray(o_M, d_M);
          if (!span.empty()) spans.push_back(span);
        } else {
          torus_line(shape, o_M, d_M, spans);
        }
      },
      member.shape);
}

// Joins two lists of intervals: `inside(in_a, in_b)` says what the result holds.
template <typename Inside>
Spans joined(const Spans& a, const Spans& b, Inside&& inside) {
  std::vector<double> ends;
  for (const Spans* list : {&a, &b}) {
    for (const RayInterval& span : *list) ends.insert(ends.end(), {span.enter, span.leave});
  }
  std::sort(ends.begin(), ends.end());
  Spans result;
  std::size_t i = 0, j = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double low = ends[k], high = ends[k + 1];
    if (!(low < high)) continue;
    while (i < a.size() && a[i].leave <= low) ++i;
    while (j < b.size() && b[j].leave <= low) ++j;
    const bool in_a = i < a.size() && a[i].enter <= low, in_b = j < b.size() && b[j].enter <= low;
    if (!inside(in_a, in_b)) continue;
    if (!result.empty() && result.back().leave == low) {
      result.back().leave = high;
    } else {
      result.push_back({low, high});
    }
  }
  return result;
}

}  // namespace

void csg_line(const Csg& solid, const Vec3& o, const Vec3& d, Spans& spans) {
  std::vector<Spans> waiting;
  for (const Csg::Step& step : solid.steps()) {
    if (step.member >= 0) {
      waiting.emplace_back();
      member_line(solid.members()[step.member], o, d, waiting.back());
      continue;
    }
    const Spans b = std::move(waiting.back());
    waiting.pop_back();
    Spans& a = waiting.back();
    a = joined(a, b, [&step](bool in_a, bool in_b) {
      if (step.operation == Csg::Operation::kUnion) return in_a || in_b;
      if (step.operation == Csg::Operation::kIntersection) return in_a && in_b;
      return in_a && !in_b;
    });
  }
  spans = std::move(waiting.back());
}

}  // namespace volcontact

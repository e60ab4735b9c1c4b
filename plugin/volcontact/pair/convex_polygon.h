// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

namespace volcontact {

/// a + b x + c y over a plane.
struct Linear2 {
  double a, b, c;
  double operator()(double x, double y) const { return a + b * x + c * y; }
};

/// Convex polygon in a coordinate plane, cut by lines. Keeps its memory from one use to the next.
class ConvexPolygon {
 public:
  struct Point {
    double x, y;
  };

  /// Rectangle |x| <= half_x, |y| <= half_y.
  void start(double half_x, double half_y) {
    points_.assign({{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}});
  }
  const std::vector<Point>& points() const { return points_; }
  bool empty() const { return points_.size() < 3; }

  /// Keeps what has height <= 0.
  void cut(const Linear2& height) {
    const std::size_t count = points_.size();
    if (count == 0) return;
    kept_.clear();
    Point last = points_[count - 1];
    double last_height = height(last.x, last.y);
    for (const Point& p : points_) {
      const double h = height(p.x, p.y);
      if ((h > 0.0) != (last_height > 0.0)) {
        const double t = last_height / (last_height - h);
        kept_.push_back({last.x + t * (p.x - last.x), last.y + t * (p.y - last.y)});
      }
      if (!(h > 0.0)) kept_.push_back(p);
      last = p;
      last_height = h;
    }
    points_.swap(kept_);
  }

  double area() const {
    double twice = 0.0;
    for_each_triangle([&](double twice_area, const std::array<Point, 3>&) { twice += twice_area; });
    return 0.5 * twice;
  }

  /// Integral of f, exact for quadratic f.
  template <typename F>
  double integral(F&& f) const {
    double sum = 0.0;
    for_each_triangle([&](double twice_area, const std::array<Point, 3>& middles) {
      sum += twice_area * (f(middles[0].x, middles[0].y) + f(middles[1].x, middles[1].y) +
                           f(middles[2].x, middles[2].y));
    });
    return sum / 6.0;
  }

 private:
  // visit(twice the area, middles of the three edges)
  template <typename Visit>
  void for_each_triangle(Visit&& visit) const {
    for (std::size_t i = 2; i < points_.size(); ++i) {
      const Point &p = points_[0], &q = points_[i - 1], &r = points_[i];
      const double twice = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
      visit(twice, std::array<Point, 3>{{{0.5 * (p.x + q.x), 0.5 * (p.y + q.y)},
                                         {0.5 * (q.x + r.x), 0.5 * (q.y + r.y)},
                                         {0.5 * (r.x + p.x), 0.5 * (r.y + p.y)}}});
    }
  }

  std::vector<Point> points_, kept_;
};

}  // namespace volcontact

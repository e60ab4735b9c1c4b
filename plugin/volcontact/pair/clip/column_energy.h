// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// A linear function of the place (u, v) across the columns: a height, or the side of a line.
struct HeightPlane {
  double at_origin = 0.0;
  double per_u = 0.0;
  double per_v = 0.0;

  double operator()(const Vec2& p) const { return at_origin + per_u * p.x() + per_v * p.y(); }
  HeightPlane operator-(const HeightPlane& other) const {
    return {at_origin - other.at_origin, per_u - other.per_u, per_v - other.per_v};
  }
};

/// A convex region cut into columns, between its upper and its lower faces, of two solids that are
/// pressed together along the columns. The upper faces should belong to the solid below (its top,
/// inside the one above) and the lower faces to the solid above; a face of the other solid is an
/// overhang. Keeps its memory from one use to the next.
class ColumnEnergy {
 public:
  using Point = Vec2;

  /// Empties it, for faces with numbers below `face_count`.
  void start(int face_count);
  /// A face with its outline, counterclockwise seen from above. A lower face also needs the numbers
  /// of the faces around it.
  void add_upper(const HeightPlane& height, bool overhang, std::span<const Point> outline);
  void add_lower(int face, const HeightPlane& height, bool overhang, std::span<const Point> outline,
                 std::span<const int> neighbors);
  /// Planes over the solid below (its top is their minimum) and under the solid above (its bottom
  /// is their maximum); needed only where there is an overhang.
  void add_ceiling(const HeightPlane& plane) { ceiling_.push_back(plane); }
  void add_floor(const HeightPlane& plane) { floor_.push_back(plane); }
  bool has_overhang() const { return has_overhang_; }

  /// int [L^2/2 + L o] du dv over the columns: L is the column's length, the overhang o how far the
  /// solid below reaches over the column's top and the solid above under its bottom. Without
  /// overhang this is int L^2/2. Its derivative along the columns is V always, so it is the
  /// potential of f = V. docs/theory.md, "Volume metrics".
  double value();

  /// int L (how far a plane, that lies over all upper faces, is over the column's top) du dv.
  double value_above(const HeightPlane& plane);

 private:
  struct Upper {
    int first, count;  // in outlines_
    HeightPlane height;
    bool overhang;
    Point min, max;  // of the outline
  };
  struct Lower {
    int face;
    int first, count;  // in neighbors_
    HeightPlane height;
    bool overhang;
    Point min, max;
    int first_line = 0, line_count = 0;  // in lines_
  };
  // A convex polygon being cut by lines. It borrows the points it starts with.
  struct Polygon {
    const Point* points = nullptr;
    int count = 0;

    void reserve(int most_points);
    void assign(const Point* from, int from_count) {
      points = from;
      count = from_count;
    }
    void cut(const HeightPlane& side);  // keeps side <= 0
    double integral(const HeightPlane& a, const HeightPlane& b) const;

   private:
    std::vector<Point> buffers_[2];
    std::vector<double> sides_;
    int next_ = 0;  // buffer to write to
  };

  // Calls visit(top, bottom, length) for the cells that are not empty, one after the other cell_.
  template <typename Visit>
  void for_cells(const Visit& visit);
  void list_lines();
  void reserve();
  void cut_cell(const Upper& top, const Lower& bottom);
  double overhang_energy(const HeightPlane& length, std::span<const HeightPlane> reaches);
  void list_reaches(std::span<const Point> cell, const HeightPlane& from,
                    std::span<const HeightPlane> planes, double sign,
                    std::vector<HeightPlane>& reaches) const;

  std::vector<Point> outlines_;
  std::vector<int> neighbors_;
  std::vector<Upper> upper_;
  std::vector<Lower> lower_;
  std::vector<int> lower_of_face_;  // index in lower_, -1 for none
  std::vector<HeightPlane> ceiling_, floor_;
  bool has_overhang_ = false;
  std::vector<HeightPlane> lines_;  // positive where the lower face next to one is lower
  Polygon cell_, part_;
  // Heights of planes over a face: those that matter over the face, and in a cell of it.
  std::vector<HeightPlane> face_reaches_, reaches_;
};

}  // namespace volcontact

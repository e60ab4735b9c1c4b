// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "volcontact/pair/window/solid_view.h"

namespace volcontact {

/// A face of A (owner 0) or B (owner 1) in the octree's frame W: a quadric, or, for a solid known
/// by its signed distance only, the solid itself. A sampled field is read from the cell's samples.
struct CellFace {
  Quadric quadric;
  int owner = 0;
  const SolidView* field = nullptr;  ///< null for a quadric
  Pose X_SW;                         ///< of the field

  bool sampled() const { return field && !field->curvature_bound; }
};

/// What a cell contributes. Moments about the cell's centre, in W.
struct CellSums {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  struct Surface {
    Vec3 area_vector = Vec3::Zero();  ///< int n dS, n outward of the owner
    Vec3 moment = Vec3::Zero();       ///< int x cross n dS
    double area = 0.0;
  };
  std::array<Surface, 2> surface;  ///< of A inside B, of B inside A
};

/// One cell of the octree: a box in W, the faces that may pass through it, and what it contributes.
struct Cell {
  static constexpr int kListed = 20;  ///< more faces than that are not listed

  Vec3 center;
  Vec3 half;
  int first_face = 0;  ///< the faces of the region the cell belongs to ...
  int face_count = 0;
  std::int16_t listed = -1;  ///< ... of which these may pass through the cell; -1: any
  std::array<std::uint16_t, kListed> list;
  /// Signed distances of a sampled field, by owner: at the centre and the eight corners.
  std::array<std::array<double, 9>, 2> samples;

  bool empty = false;      ///< certainly no overlap in it
  bool rough = false;      ///< only the bounds are worked out, and `sums.volume` between them
  std::uint8_t split = 7;  ///< bits of the axes to halve next
  double low = 0.0;        ///< volume is certainly not less ...
  double high = 0.0;       ///< ... and not more
  std::array<double, 2> doubt = {0.0, 0.0};  ///< share of high - low by the owner of the face
  CellSums sums;
  Vec3 content_low, content_high;  ///< box that holds the overlap in the cell, from its centre
};

}  // namespace volcontact

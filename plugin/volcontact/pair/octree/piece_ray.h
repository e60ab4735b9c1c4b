// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"

namespace volcontact {

/// First t >= `from` where f(t) = a t^2 + b t + c becomes positive, given that it is not at `from`.
inline double first_exit(double a, double b, double c, double from) {
  const double square = b * b - 4.0 * a * c;
  if (a == 0.0 || std::abs(a * c) < 1e-16 * b * b) {
    if (b > 0.0) return std::max(from, -c / b);
    // All but straight: the far root is the one that counts.
    return a > 0.0 ? std::max(from, -b / a) : kInfinity;
  }
  if (!(square > 0.0)) return a > 0.0 ? from : kInfinity;
  const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
  const double one = q / a, other = c / q;
  const double first = std::min(one, other), second = std::max(one, other);
  if (a > 0.0) return std::max(from, second);
  return first >= from ? first : kInfinity;
}

/// How far the ray p + t d, d of length 1, stays in the solid when it is in it at t = `nudge` (zero
/// when it is not). Gaps between pieces narrower than `nudge` are no gaps.
inline double way_inside(const PieceList& list, const Vec3& p, const Vec3& d, double nudge) {
  double way = 0.0;
  const auto leaves_piece = [&](int piece) {
    const double from = way + nudge;
    double leave = kInfinity;
    for (const Quadric* face = list.begin(piece); face != list.end(piece); ++face) {
      double a = 0.0, b = d.dot(face->linear), c = face->constant + p.dot(face->linear);
      if (face->bend != Bend::kFlat) {
        const Vec3 bent = face->hessian * d;
        a = 0.5 * d.dot(bent);
        b += p.dot(bent);
        c += 0.5 * p.dot(face->hessian * p);
      }
      if (c + from * (b + from * a) > 0.0) return 0.0;
      leave = std::min(leave, first_exit(a, b, c, from));
    }
    return leave;
  };
  for (bool further = true; further;) {
    further = false;
    for (int piece = 0; piece < list.size(); ++piece) {
      const double leave = leaves_piece(piece);
      if (!(leave > way + nudge)) continue;
      way = leave;
      if (!std::isfinite(way)) return way;
      further = list.size() > 1;
    }
  }
  return way;
}

}  // namespace volcontact

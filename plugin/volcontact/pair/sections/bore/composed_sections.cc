// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/bore/composed_sections.h"

#include <algorithm>

#include "volcontact/pair/sections/region_join.h"

namespace volcontact {
namespace {

constexpr double kNearAxis = 1e-9;  // of a place from the axis of a bore, per its distance

class ComposedRun {
 public:
  ComposedRun(const Pose& X_AB, const InterferenceOptions& options, LinesScratch& lines,
              ComposedScratch& scratch, Interference& out)
      : X_AB_(X_AB), options_(options), lines_(lines), s_(scratch), out_(out) {}

  bool run() {
    s_.regions.cut(0);
    for (std::size_t a = 0; a < s_.pieces[0].size(); ++a) {
      for (std::size_t b = 0; b < s_.pieces[1].size(); ++b) {
        const std::size_t before = s_.regions.size();
        if (!add_regions(s_.pieces[0][a], s_.pieces[1][b])) return false;
        for (std::size_t i = before; i < s_.regions.size(); ++i) {
          s_.regions[i].piece[0] = static_cast<int>(a);
          s_.regions[i].piece[1] = static_cast<int>(b);
        }
      }
    }
    join_regions(
        s_.regions, s_.site_of,
        [this](const LinesRegion& region, const LinesRegion::PlanePatch& patch) {
          return holds(region, patch);
        },
        out_);
    return true;
  }

 private:
  bool add_regions(const LinesPiece& a, const LinesPiece& b) {
    const Pose X_BodyA_A = a.X_SB.inverse();
    const Pose X = X_BodyA_A * X_AB_ * b.X_SB;  // body B in body A
    if (!find_bores(a, b, X)) return false;
    const std::size_t before = s_.regions.size();
    if (s_.bores.empty()) {
      if (!add_lines_region(a.body, b.body, X, options_, lines_, s_.regions)) return false;
    } else if (!bored_lines(a.body, b.body, X, s_.bores[0].bore, s_.bores[0].owner, options_,
                            lines_, s_.bore, s_.regions)) {
      return false;
    }
    for (std::size_t i = before; i < s_.regions.size(); ++i) {
      LinesRegion& region = s_.regions[i];
      region.metrics = transformed(region.metrics, a.X_SB);
      std::erase_if(region.patches, [](const auto& patch) { return !(patch.area > 0.0); });
      for (LinesRegion::PlanePatch& patch : region.patches) {
        patch.normal = a.X_SB.rotation * patch.normal;
        patch.offset += patch.normal.dot(a.X_SB.translation);
        patch.centroid = a.X_SB * patch.centroid;
      }
      std::erase_if(region.patches, [&](const LinesRegion::PlanePatch& patch) {
        const bool of_a = patch.owner == Owner::kA;
        return !lies_in_seam(patch, of_a ? a.seams : b.seams, of_a ? Pose{} : X_AB_);
      });
    }
    return true;
  }

  // The bores that both bodies reach, in body A's frame; false for more than one.
  bool find_bores(const LinesPiece& a, const LinesPiece& b, const Pose& X) {
    s_.bores.clear();
    const auto add = [&](const LinesPiece& piece, Owner owner, const Pose& X_SolidBodyA) {
      if (!piece.bores) return;
      for (const Bore& in_solid : *piece.bores) {
        const Bore bore = transformed(in_solid, X_SolidBodyA);
        const bool reached =
            owner == Owner::kA ? reaches(b.body, X, bore) : reaches(a.body, Pose{}, bore);
        if (reached) s_.bores.push_back({bore, owner});
      }
    };
    add(a, Owner::kA, a.X_SB);
    add(b, Owner::kB, X_AB_.inverse() * a.X_SB);
    return s_.bores.size() <= 1;
  }

  // False when a plane that touches the wall along a line keeps the two apart.
  static bool reaches(const ConvexView& body, const Pose& X, const Bore& bore) {
    if (!body.bounded()) return true;
    const Vec3 middle = body.middle(X), out = bore.from_axis(middle);
    const double length = out.norm();
    // On the axis it is in the bore, and what is left of `out` is rounding that points anywhere.
    if (!(length > kNearAxis * ((middle - bore.center).norm() + bore.radius))) return true;
    const Vec3 normal = bore.wall_normal(out / length);
    return -body.support_height(X, -normal) - normal.dot(bore.center) < bore.radius;
  }

  // Whether the middle of a patch belongs to a region as well.
  bool holds(const LinesRegion& region, const LinesRegion::PlanePatch& patch) const {
    const double slack = patch_slack(patch);
    for (Owner owner : {Owner::kA, Owner::kB}) {
      const LinesPiece& piece = s_.pieces[index(owner)][region.piece[index(owner)]];
      const Pose X = owner == Owner::kA ? piece.X_SB : X_AB_ * piece.X_SB;
      const RayInterval span = piece.body.ray(X, patch.centroid, patch.normal);
      if (span.empty() || span.enter > slack || span.leave < -slack) return false;
    }
    return true;
  }

  const Pose& X_AB_;
  const InterferenceOptions& options_;
  LinesScratch& lines_;
  ComposedScratch& s_;
  Interference& out_;
};

}  // namespace

void add_lines_pieces(const Csg& solid, std::vector<LinesPiece>& pieces) {
  for (const CarvedPiece& piece : solid.carved_pieces()) {
    std::visit(
        [&](const auto& body) {
          if constexpr (HasFaces<std::decay_t<decltype(body)>>) {
            pieces.push_back({ConvexView(body), piece.X_SB, &piece.bores, &piece.seams});
          }
        },
        piece.body);
  }
}

bool has_lines_pieces(const Csg& solid) {
  const std::vector<CarvedPiece>& pieces = solid.carved_pieces();
  return !pieces.empty() && std::all_of(pieces.begin(), pieces.end(), [](const CarvedPiece& piece) {
    return piece.bores.size() == piece.carved.size();
  });
}

bool composed_lines(const Pose& X_AB, const InterferenceOptions& options, LinesScratch& lines,
                    ComposedScratch& scratch, Interference& out) {
  return ComposedRun(X_AB, options, lines, scratch, out).run();
}

}  // namespace volcontact

// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/mesh_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "volcontact/base/thread_team.h"
#include "volcontact/pair/mesh_columns/contained.h"
#include "volcontact/pair/mesh_columns/nearest_face.h"

namespace volcontact {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kReach = 1e-13;      // of the size: where rounding decides whether faces touch
constexpr int kMostContacts = 20000;  // of one query
constexpr double kFlux = 1e-8;        // of the square of the length of a curve
constexpr double kNoCellArea = 1e-8;  // of the largest cell: rounding has made it
constexpr double kAtEdge = 1e-9;      // of an edge: how far a point may be off it
constexpr double kCentroid = 1e-9;    // of the size: how far out of bounds it may be
constexpr double kOpen = 1e-9;        // of the faces seen: how far a closed surface is from closing
constexpr double kAside = 1e-3;       // of columns that see upright faces, too [rad]

class Columns {
 public:
  // Without b: the half-space z < 0 of B's frame.
  Columns(const SurfaceView& a, const SurfaceView* b, const Pose& X_AB,
          const InterferenceOptions& options, ColumnsScratch& scratch, Interference& out)
      : a_(a),
        b_(b),
        X_AB_(X_AB),
        X_BA_(X_AB.inverse()),
        most_leaf_pairs_(options.most_cells),
        threads_(thread_limit(options.threads)),
        scratch_(scratch),
        out_(out) {
    rounding_ = 4.0 * kEpsilon *
                (size_of(a.bounds) + X_AB.translation.cwiseAbs().sum() +
                 (b != nullptr ? size_of(b->bounds) : 0.0));
    out.total = VolumeMetrics{};
    out.sites.clear();
  }

  void meshes() {
    if (bounds_apart(a_.bounds, b_->bounds, X_AB_)) return;
    if (b_->planes != nullptr && add_on_one_face()) return finish();
    dropped_ = 0.0;
    const double reach = kReach * (size_of(a_.bounds) + size_of(b_->bounds));
    if (coincide(a_, *b_, X_BA_, reach, scratch_.slot_of_triangle)) return add_coinciding(reach);
    const bool counted =
        find_contacts(*a_.tree, *b_->tree, X_BA_, reach, kMostContacts, scratch_.crossing);
    for (std::vector<int>& parts : scratch_.crossing_parts) parts.clear();
    if (!counted || !add_patches()) {
      out_.sites.clear();
      dropped_ = 0.0;
      add_all_columns();
    }
    finish();
  }

  void half_space() {
    const Pose& X_CA = X_BA_;
    const Vec3 up_A = X_CA.rotation.row(2);
    const Vec3 middle = X_CA * a_.bounds.center();
    const double reach = a_.bounds.half_sizes().dot(up_A.cwiseAbs());
    if (middle.z() - reach >= 0.0) return;
    if (middle.z() + reach <= 0.0) return add_immersed();
    make_cells_below(*a_.tree, X_CA, scratch_.cells);
    add_regions(X_CA, Pose{}, X_AB_, nullptr);
    finish();
  }

 private:
  // The whole of A below the half-space's plane, where the depth still means something.
  void add_immersed() {
    VolumeMetrics m = a_.own;
    const Vec3 up_A = X_BA_.rotation.row(2);
    m.area = a_.surface_area;
    m.volume_error = rounding_ * m.area;
    m.status = Status::kContained;
    m.depth_moment = -(X_BA_ * m.centroid).z() * m.volume;
    m.depth = a_.bounds.half_sizes().dot(up_A.cwiseAbs()) - (X_BA_ * a_.bounds.center()).z();
    out_.sites.push_back(m);
    finish();
  }

  // The same surface twice: all of the solid, and no direction. Every face of A is flush with one
  // of B, and so is B's.
  void add_coinciding(double reach) {
    VolumeMetrics m = a_.own;
    m.counter_area = a_.surface_area;
    m.volume_error = reach * a_.surface_area;
    m.status = Status::kContained;
    out_.sites.push_back(m);
    finish();
  }

  // What A's surface cuts off a convex B when it meets only one of its faces: a half-space would
  // lose as much. False when it meets others, or none.
  bool add_on_one_face() {
    Pose X_BC;
    switch (nearest_face(a_.bounds, *b_, X_BA_, rounding_, scratch_.prism, X_BC)) {
      case FaceReach::kApart:
        return true;
      case FaceReach::kWhole:
        return false;
      case FaceReach::kPart:
        break;
    }
    const Pose X_CA = X_BC.inverse() * X_BA_;
    if (!make_cells_in_prism(*a_.tree, X_CA, scratch_.prism, scratch_.cells)) return false;
    if (cells().empty()) return false;
    add_regions(X_CA, Pose{}, X_AB_ * X_BC, nullptr);
    return !out_.sites.empty();
  }

  std::vector<ColumnCell>& cells() { return scratch_.cells.cells; }

  // Each patch on its own, and what does not cross. False when some patch needs all the columns.
  bool add_patches() {
    if (!scratch_.crossing.contacts.empty()) {
      if (!find_patches(scratch_.crossing.contacts, scratch_.patches)) return false;
      for (const ContactPatch& patch : scratch_.patches.patches) {
        if (!add_patch(patch)) return false;
      }
      if (a_.part_count() == 1 && b_->part_count() == 1) return true;
    }
    auto& crossing = scratch_.crossing_parts;
    for (std::vector<int>& parts : crossing) std::sort(parts.begin(), parts.end());
    const VolumeMetrics inside =
        contained_parts(a_, *b_, X_AB_, crossing[0], crossing[1], scratch_.cells);
    if (inside.volume > 0.0) {
      out_.sites.push_back(inside);
      out_.sites.back().volume_error = rounding_ * (inside.area + inside.counter_area);
    } else if (inside.volume < 0.0) {
      // A cavity within the overlap of the surfaces around it.
      const auto largest = std::max_element(
          out_.sites.begin(), out_.sites.end(),
          [](const VolumeMetrics& x, const VolumeMetrics& y) { return x.volume < y.volume; });
      if (largest == out_.sites.end()) return false;
      *largest = *largest + inside;
      largest->status = Status::kOk;
    }
    return true;
  }

  // Columns from B to A through one patch alone: right when A does not reach below the window, nor
  // B above it, nor the overlap out of it at the sides, and when A's surface found inside of B is
  // the one that the curve of the patch bounds.
  bool add_patch(const ContactPatch& patch) {
    if (!patch.flux.closed || patch.flux.toward_a.isZero()) return false;
    if (!(patch.flux.length > 0.0)) return false;  // a mere touch tells nothing
    const std::vector<TriangleContact>& contacts = scratch_.crossing.contacts;
    const Pose X_BC{columns_along(contacts, scratch_.patches, patch),
                    0.5 * (patch.low + patch.high)};
    const Mat3& R_BC = X_BC.rotation;
    const Pose X_CB = X_BC.inverse();
    const Pose X_CA = X_CB * X_BA_;
    const Aabb curve = bounds_of(contacts, scratch_.patches, patch, X_CB);
    const Vec3 size = curve.max - curve.min;
    const double margin = rounding_ + 1e-9 * size.maxCoeff();
    const double least = std::min(size.x(), size.y()), most = std::max(size.x(), size.y());
    const double doubt = kFlux * patch.flux.length * patch.flux.length;
    struct Attempt {
      double bulge;
      bool level;  // A does not reach below the window, nor B above it
    };
    // Beside a patch that goes far around a pin, A may well reach below the window. Without layers,
    // B's surface in the cells then tells as A's does whether they are whole.
    for (const auto& [bulge, level] :
         {Attempt{0.5 * least, true}, {most, true}, {0.1 * least, false}}) {
      const Vec3 around(margin, margin, bulge + margin);
      const ColumnWindow window{curve.min - around, curve.max + around};
      if (level && (meets_level(*a_.tree, X_CA, window, window.low.z(), scratch_.cells) ||
                    meets_level(*b_->tree, X_CB, window, window.high.z(), scratch_.cells))) {
        continue;
      }
      if (!find_leaf_pairs(*a_.tree, X_CA, *b_->tree, X_CB, window, most_leaf_pairs_,
                           scratch_.cells)) {
        return false;
      }
      make_cells(*a_.tree, X_CA, *b_->tree, X_CB, window, threads_, scratch_.cells);
      keep_crossing_parts(patch);
      if (level) drop_beyond_levels(window);
      if (!ends_outwards()) continue;
      const bool shared = !is_within(window, nullptr);
      // One curve bounds one region, and without upright faces no wall of it is out of sight.
      const bool simple =
          !shared && patch.one_curve && !scratch_.cells.upright && !is_layered(cells());
      if (simple) {
        scratch_.regions.region_of.assign(cells().size(), CellRegion{0, 0, -1, -1});
        scratch_.own_regions.assign(1, 1);
      }
      if ((shared || !level) && is_layered(cells())) continue;
      if (!level && scratch_.cells.upright) continue;
      if (shared && !find_own_regions(patch, window)) continue;
      if (meets_other_curve(patch, X_CB, margin, shared)) return false;
      const Vec3 area_vector =
          R_BC * add_regions(X_CA, X_CB, X_AB_ * X_BC, b_->tree, shared || simple);
      if (!level && (R_BC * area_vector_of_b(shared) + patch.flux.area_vector).norm() > doubt) {
        return false;
      }
      return (area_vector - patch.flux.area_vector).norm() <= doubt;
    }
    return false;
  }

  // No surface passes through the ends of the window: what lies beyond them is another part of its
  // body, of which some faces reach into the window beside the rectangle and others do not.
  void drop_beyond_levels(const ColumnWindow& window) {
    std::erase_if(cells(), [&](const ColumnCell& cell) {
      const double x = cell.x[0], y = cell.y[0];
      if (x < window.low.x() || x > window.high.x() || y < window.low.y() || y > window.high.y()) {
        return false;
      }
      const double half = 0.5 * cell.delta[0];
      return cell.middle[0] - half < window.low.z() || cell.middle[0] + half > window.high.z();
    });
  }

  // Whether the curve of another patch bounds what the cells hold, of all regions or of those that
  // are marked: that patch would count it again. So it is with a body whose ends are flush with two
  // opposite faces of the other one.
  bool meets_other_curve(const ContactPatch& patch, const Pose& X_CB, double margin, bool own) {
    const PatchScratch& patches = scratch_.patches;
    if (patches.patches.size() == 1) return false;
    const Aabb bounds = bounds_of_cells(margin, own);
    const Vec3 middle = bounds.center(), half = bounds.half_sizes();
    for (const ContactPatch& other : patches.patches) {
      if (other.first == patch.first) continue;
      const Vec3 apart = X_CB * (0.5 * (other.low + other.high)) - middle;
      const Vec3 reach = X_CB.rotation.cwiseAbs() * (0.5 * (other.high - other.low)) + half;
      if (apart.cwiseAbs().exceeds(reach)) continue;
      for (int k = other.first; k < other.last; ++k) {
        const TriangleContact& contact = scratch_.crossing.contacts[patches.order[k]];
        const Vec3 p = X_CB * contact.p;
        if (!contact.proper) {  // of a touch only a box is known
          const Vec3 extent = contact.q - contact.p;
          const Vec3 away = p + X_CB.rotation * (0.5 * extent) - middle;
          const Vec3 far = half + X_CB.rotation.cwiseAbs() * (0.5 * extent);
          if (away.cwiseAbs().at_most(far)) return true;
        } else if ((p - middle).cwiseAbs().at_most(half) && is_on_cells(p, margin, own)) {
          return true;
        }
      }
    }
    return false;
  }
  Aabb bounds_of_cells(double margin, bool own) const {
    Aabb bounds{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
    for (std::size_t k = 0; k < scratch_.cells.cells.size(); ++k) {
      if (!counts(k, own)) continue;
      const ColumnCell& cell = scratch_.cells.cells[k];
      for (int i = 0; i < cell.count; ++i) {
        const Vec3 p(cell.x[i], cell.y[i], cell.middle[i]);
        const Vec3 reach(margin, margin, 0.5 * cell.delta[i] + margin);
        bounds.min = bounds.min.cwiseMin(p - reach);
        bounds.max = bounds.max.cwiseMax(p + reach);
      }
    }
    return bounds;
  }
  // Whether a cell is one of those that a patch counts.
  bool counts(std::size_t k, bool own) const {
    return !own || scratch_.own_regions[scratch_.regions.region_of[k].of_f] != 0;
  }
  bool is_on_cells(const Vec3& p, double margin, bool own) {
    for (std::size_t k = 0; k < cells().size(); ++k) {
      const ColumnCell& cell = cells()[k];
      if (counts(k, own) && cell.covers(p.x(), p.y(), kAtEdge) &&
          cell.height_of_f(p.x(), p.y()) <= p.z() + margin &&
          cell.height_of_g(p.x(), p.y()) >= p.z() - margin) {
        return true;
      }
    }
    return false;
  }

  // Of B's surface in cells without layers, of all regions or of those that are marked; in C.
  Vec3 area_vector_of_b(bool own) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < cells().size(); ++k) {
      const ColumnCell& cell = cells()[k];
      if (own && !scratch_.own_regions[scratch_.regions.region_of[k].of_g]) continue;
      sum += cell.area * Vec3(-cell.slope_g[0], -cell.slope_g[1], 1.0);
    }
    return sum;
  }

  // Whether the cells end within the sides of a window; of all regions, or of those listed.
  bool is_within(const ColumnWindow& window, const std::vector<char>* regions) {
    double least = 0.0;
    for (const ColumnCell& cell : cells()) least = std::max(least, cell.area);
    least *= kNoCellArea;
    for (std::size_t k = 0; k < cells().size(); ++k) {
      const ColumnCell& cell = cells()[k];
      if (!(cell.area > least)) continue;
      if (regions != nullptr && !(*regions)[scratch_.regions.region_of[k].of_f]) continue;
      for (int i = 0; i < cell.count; ++i) {
        if (cell.x[i] < window.low.x() || cell.x[i] > window.high.x() ||
            cell.y[i] < window.low.y() || cell.y[i] > window.high.y()) {
          return false;
        }
      }
    }
    return true;
  }

  // Marks the regions that the contacts of a patch belong to. A window on it may hold cells of its
  // neighbours too, not all of them. False when its own are not whole either. Not for layered
  // cells.
  bool find_own_regions(const ContactPatch& patch, const ColumnWindow& window) {
    std::vector<std::pair<int, int>>& pairs = scratch_.own_pairs;
    pairs.clear();
    for (int k = patch.first; k < patch.last; ++k) {
      const TriangleContact& contact = scratch_.crossing.contacts[scratch_.patches.order[k]];
      pairs.emplace_back(contact.f, contact.g);
    }
    std::sort(pairs.begin(), pairs.end());
    const int regions = find_regions(*a_.tree, b_->tree, rounding_, cells(), scratch_.regions);
    std::vector<char>& own = scratch_.own_regions;
    own.assign(static_cast<std::size_t>(regions), 0);
    for (std::size_t k = 0; k < cells().size(); ++k) {
      const ColumnCell& cell = cells()[k];
      if ((cell.labels & 1u << kCrossing) == 0) continue;
      if (!std::binary_search(pairs.begin(), pairs.end(), std::pair(cell.f, cell.g))) continue;
      own[scratch_.regions.region_of[k].of_f] = 1;
    }
    return is_within(window, &own);
  }

  // Whether, where several faces lie above each other, the lowest of A and the highest of B look
  // outwards.
  bool ends_outwards() {
    const ColumnCell* largest = nullptr;
    for (const ColumnCell& cell : cells()) {
      if (largest == nullptr || cell.area > largest->area) largest = &cell;
    }
    if (largest == nullptr || !is_layered(cells())) return true;
    double x = 0.0, y = 0.0;
    for (int i = 0; i < largest->count; ++i) {
      x += largest->x[i] / largest->count;
      y += largest->y[i] / largest->count;
    }
    const ColumnCell *lowest = nullptr, *highest = nullptr;
    double low = kInfinity, high = -kInfinity;
    for (const ColumnCell& cell : cells()) {
      if (!cell.covers(x, y)) continue;
      const double f = cell.height_of_f(x, y), g = cell.height_of_g(x, y);
      if (f < low) low = f, lowest = &cell;
      if (g > high) high = g, highest = &cell;
    }
    return lowest != nullptr && lowest->sign_f < 0 && highest->sign_g > 0;
  }

  // Of a surface of several parts, only those that cross in this patch are its business.
  void keep_crossing_parts(const ContactPatch& patch) {
    if (a_.part_count() == 1 && b_->part_count() == 1) return;
    auto& here = scratch_.crossing_here;
    for (std::vector<int>& parts : here) parts.clear();
    for (int k = patch.first; k < patch.last; ++k) {
      const TriangleContact& contact = scratch_.crossing.contacts[scratch_.patches.order[k]];
      here[0].push_back(a_.part_of_slot(contact.f));
      here[1].push_back(b_->part_of_slot(contact.g));
    }
    for (int side = 0; side < 2; ++side) {
      std::sort(here[side].begin(), here[side].end());
      here[side].erase(std::unique(here[side].begin(), here[side].end()), here[side].end());
      auto& all = scratch_.crossing_parts[side];
      all.insert(all.end(), here[side].begin(), here[side].end());
    }
    const auto holds = [](const std::vector<int>& parts, int part) {
      return std::binary_search(parts.begin(), parts.end(), part);
    };
    std::erase_if(cells(), [&](const ColumnCell& cell) {
      return !holds(here[0], a_.part_of_slot(cell.f)) || !holds(here[1], b_->part_of_slot(cell.g));
    });
  }

  // All columns along one direction; when they are too many, some of them.
  void add_all_columns() {
    const std::vector<TriangleContact>& contacts = scratch_.crossing.contacts;
    scratch_.patches.order.resize(contacts.size());
    std::iota(scratch_.patches.order.begin(), scratch_.patches.order.end(), 0);
    const int* order = scratch_.patches.order.data();
    Vec3 toward_a = flux_of(contacts, order, order + contacts.size()).toward_a;
    if (toward_a.isZero()) toward_a = Vec3::UnitZ();
    Pose X_BC{basis_with_z(toward_a), b_->bounds.center()};
    // Where an edge of one body runs along an upright face of the other, whether there is a wall is
    // told by rounding. Columns a little aside see the face.
    for (const double aside : {0.0, kAside}) {
      X_BC.rotation = X_BC.rotation * rotation_about(Vec3(0.8, 0.6, 0.0), aside);
      const Pose X_CB = X_BC.inverse();
      const Pose X_CA = X_CB * X_BA_;
      if (!find_leaf_pairs(*a_.tree, X_CA, *b_->tree, X_CB, ColumnWindow{}, most_leaf_pairs_ / 2,
                           scratch_.cells)) {
        break;
      }
      make_cells(*a_.tree, X_CA, *b_->tree, X_CB, ColumnWindow{}, threads_, scratch_.cells);
      add_regions(X_CA, X_CB, X_AB_ * X_BC, b_->tree);
      if (closes_ || aside > 0.0) return;
      out_.sites.clear();
      dropped_ = 0.0;
    }
    const Pose X_CB = X_BC.inverse();
    const Pose X_CA = X_CB * X_BA_;
    const VolumeMetrics m = sampled_columns(a_, X_CA, *b_, X_CB, scratch_.cells, scratch_.sampled);
    sampled_ = m;
    if (m.touching()) out_.sites.push_back(transformed(m, X_AB_ * X_BC));
  }

  // Returns the area vector of A's surface in them, in C.
  // `own`: only the regions that are marked.
  Vec3 add_regions(const Pose& X_CA, const Pose& X_CB, const Pose& X_AC, const ObbTree* tree_b,
                   bool own = false) {
    const int regions = own ? static_cast<int>(scratch_.own_regions.size())
                            : find_regions(*a_.tree, tree_b, rounding_, cells(), scratch_.regions);
    const ColumnSurface a{a_.tree, &X_CA}, b{tree_b, &X_CB};
    // At most the volume of slivers of faces that count as none.
    const double left_out = own ? 0.0 : scratch_.regions.left_out * size_of(a_.bounds);
    std::vector<CellSum>& sums = scratch_.sums;
    sums.clear();
    Vec3 area_vector = Vec3::Zero(), open = Vec3::Zero();
    double seen = 0.0;
    for (int region = 0; region < regions; ++region) {
      if (own && !scratch_.own_regions[static_cast<std::size_t>(region)]) continue;
      sums.push_back(
          sum_region(region, cells(), scratch_.regions.region_of, a, b, scratch_.cells.path));
      area_vector += sums.back().moments.area_vector;
      open += sums.back().moments.area_vector + sums.back().counter_vector;
      seen += sums.back().seen;
    }
    closes_ = tree_b == nullptr || open.norm() <= kOpen * seen;
    // A surface that looks into a cavity takes its volume away from the region around it. And where
    // faces coincide, what was told apart need not be a region.
    if (sums.size() > 1 && !are_regions(sums, common_bounds(X_CA, tree_b, X_CB))) {
      for (std::size_t i = 1; i < sums.size(); ++i) sums[0] += sums[i];
      sums.resize(1);
    }
    if (is_layered(cells())) {
      double volume = 0.0;
      for (const CellSum& sum : sums) volume += std::max(0.0, sum.moments.volume);
      const double energy = energy_of(cells());
      for (CellSum& sum : sums) sum.energy = energy * (sum.moments.volume / volume);
    }
    for (const CellSum& sum : sums) {
      if (!(sum.moments.volume > error_of(sum))) {
        dropped_ += std::abs(sum.moments.volume) + error_of(sum) + left_out;
        continue;
      }
      VolumeMetrics m = sum.moments.metrics();
      m.volume_error = error_of(sum) + left_out;
      const double length = m.area_vector.norm();
      // Of faces that lie on each other rounding tells which one is the surface.
      m.area = std::max(m.area, length);
      m.counter_area = std::max(m.counter_area, length);
      const double along = length > 0.0 ? std::abs(m.area_vector.z()) / length : 1.0;
      m.depth_moment = sum.energy * along;
      m.depth = sum.depth * along;  // 0 where a region shows no face to the columns, only walls
      out_.sites.push_back(transformed(m, X_AC));
    }
    return area_vector;
  }

  // Whether each of the sums may be that of a region: no negative volume, and the centroid within
  // the bounds of both solids.
  bool are_regions(const std::vector<CellSum>& sums, const Aabb& common) const {
    const Vec3 reach = common.min.cwiseAbs().cwiseMax(common.max.cwiseAbs());
    return std::all_of(sums.begin(), sums.end(), [&](const CellSum& sum) {
      const double volume = sum.moments.volume, doubt = error_of(sum);
      const Vec3& first = sum.moments.first;
      const Vec3 slack = (doubt + kCentroid * std::abs(volume)) * reach;
      return volume >= -doubt && (first - volume * common.max).at_most(slack) &&
             (volume * common.min - first).at_most(slack);
    });
  }

  // What the bounds of A and of B have in common, in C; those of A where B is a half-space.
  Aabb common_bounds(const Pose& X_CA, const ObbTree* tree_b, const Pose& X_CB) const {
    const auto placed = [](const Aabb& bounds, const Pose& X) {
      const Vec3 middle = X * bounds.center(), half = X.rotation.cwiseAbs() * bounds.half_sizes();
      return Aabb{middle - half, middle + half};
    };
    const Aabb bounds = placed(a_.bounds, X_CA);
    if (tree_b == nullptr) return bounds;
    const Aabb other = placed(b_->bounds, X_CB);
    return {bounds.min.cwiseMax(other.min), bounds.max.cwiseMin(other.max)};
  }

  double error_of(const CellSum& sum) const {
    return 16.0 * kEpsilon * sum.absolute + rounding_ * sum.seen;
  }

  void finish() {
    out_.total = VolumeMetrics{};
    for (const VolumeMetrics& site : out_.sites) out_.total = out_.total + site;
    // Samples may miss what is there.
    out_.total.status = std::max(out_.total.status, sampled_.status);
    out_.total.volume_error = std::max(out_.total.volume_error, sampled_.volume_error) + dropped_;
  }

  const SurfaceView& a_;
  const SurfaceView* b_;
  const Pose X_AB_, X_BA_;
  const int most_leaf_pairs_, threads_;
  ColumnsScratch& scratch_;
  Interference& out_;
  double rounding_;
  bool closes_ = true;     // A's and B's surface around the regions added last, together
  double dropped_ = 0.0;   // at most, of regions too small to tell from rounding [m^3]
  VolumeMetrics sampled_;  // where the budget did not allow more
};

}  // namespace

void columns_interference(const SurfaceView& a, const SurfaceView& b, const Pose& X_AB,
                          const InterferenceOptions& options, ColumnsScratch& scratch,
                          Interference& out) {
  Columns(a, &b, X_AB, options, scratch, out).meshes();
}

void columns_interference(const SurfaceView& a, const HalfSpace&, const Pose& X_AB,
                          const InterferenceOptions& options, ColumnsScratch& scratch,
                          Interference& out) {
  Columns(a, nullptr, X_AB, options, scratch, out).half_space();
}

}  // namespace volcontact

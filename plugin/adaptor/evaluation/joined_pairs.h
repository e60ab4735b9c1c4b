// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adaptor/geoms/box_union.h"
#include "adaptor/memory/site_pool.h"
#include "adaptor/scene/scene_contact.h"
#include "volcontact/pair/window/overlap_window.h"

namespace volcontact::adaptor {

/// Near pairs of one family whose solids make one solid on each side, as far as the other reaches.
struct JoinedPair {
  std::vector<PairId> pairs;  ///< ascending; the first one leads
  /// In the frames of the pairs.
  GeometricPair solids{Sphere({}), Sphere({}), Pose{}, Pose{}};
  std::vector<PairId> site_pairs;  ///< of each site, the pair whose solids have its centroid
  std::vector<double> rows;        ///< of the sites before, where several of the pairs left some

  /// The sites that the pairs left.
  SiteMemory memory(const SitePool<const double>& pool, double elapsed);
  /// Fills `site_pairs`.
  void place_sites(const SceneContact& contact, const BodyMotion& motion,
                   const ContactReport& report);
};

/// Makes one pair of those that touch flush solids across their seams. Memory is reused from call
/// to call, and holds nothing that changes a result.
class JoinedPairs {
 public:
  /// Puts the leading pair of each joined pair into `near`, which is ascending, in place of all of
  /// them; leaves out pairs whose solids are apart.
  void build(const SceneContact& contact, const mjData* d, std::vector<PairId>& near);

  bool empty() const { return count_ == 0; }
  /// The joined pair at a place of `near`; null for a pair of no family.
  JoinedPair* at(std::size_t place) {
    return empty() || joined_at_[place] < 0 ? nullptr
                                            : &joined_[static_cast<std::size_t>(joined_at_[place])];
  }
  const JoinedPair* at(std::size_t place) const {
    return const_cast<JoinedPairs*>(this)->at(place);
  }
  /// The pair to which a site of the pair at a place of `near` belongs.
  PairId pair_of_site(std::span<const PairId> near, std::size_t place, std::size_t site) const {
    const JoinedPair* joined = at(place);
    return joined ? joined->site_pairs[site] : near[place];
  }

 private:
  struct Side {
    std::vector<int> geoms;  // ascending
    int frame = 0;
    std::vector<Aabb> bounds;
    BoxUnion tiles;

    bool has_several() const { return geoms.size() > 1; }
    int count() const { return has_several() ? tiles.count() : 1; }
    int part_of(int geom) const;
  };
  void add_family(const SceneContact& contact, const mjData* d, std::span<const PairId> pairs);
  bool join_sides(const SceneContact& contact, const mjData* d);
  void look_closer(const SceneContact& contact, const mjData* d, Side& side, const Side& other);
  void set_solid(const SceneContact& contact, const Side& side, int part, Shape& solid, Pose& X);
  JoinedPair& next();

  std::vector<JoinedPair> joined_;
  std::size_t count_ = 0;
  std::vector<int> joined_at_;
  std::vector<std::pair<PairId, PairId>> of_families_;  // family, pair
  std::vector<PairId> pairs_;
  std::vector<int> part_;
  std::vector<std::pair<PairId, int>> leads_;  // pair, its joined pair or -1
  Side a_, b_;
  CutPolytope hull_, scratch_;
};

}  // namespace volcontact::adaptor

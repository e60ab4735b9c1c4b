// SPDX-License-Identifier: Apache-2.0
#include "adaptor/volcontact_mujoco.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "adaptor/auto_attach.h"
#include "adaptor/evaluation/apply_contact.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/passive_callback.h"
#include "adaptor/readings/contact_list.h"
#include "adaptor/readings/description.h"
#include "adaptor/readings/last_evaluation.h"
#include "adaptor/scene_registry.h"
#include "adaptor/watched_steps.h"
#include "volcontact/base/check.h"
#include "volcontact/model/model_text.h"
#include "volcontact/pair/picture/overlap_surface.h"

// No exception leaves this file.

namespace volcontact::adaptor {
namespace {

// Copies as much of `text` as there is room for; returns the length of all of it.
int copy_text(std::string_view text, char* buffer, int capacity) {
  if (buffer && capacity > 0) {
    const std::size_t count = std::min(text.size(), static_cast<std::size_t>(capacity - 1));
    std::memcpy(buffer, text.data(), count);
    buffer[count] = '\0';
  }
  return static_cast<int>(text.size());
}

std::string version_mismatch() {
  if (mj_version() == mjVERSION_HEADER) return {};
  return "this adaptor was built for MuJoCo " + version_text(mjVERSION_HEADER) + " and MuJoCo " +
         version_text(mj_version()) + " is running";
}

// Runs what may throw; its result, or an error code with the message.
template <typename Function>
int guarded(char* message, int message_size, Function&& function) noexcept {
  try {
    copy_text("", message, message_size);
    const std::string mismatch = version_mismatch();
    if (!mismatch.empty()) {
      copy_text(mismatch, message, message_size);
      return VOLCONTACT_ERROR_VERSION;
    }
    return function();
  } catch (const std::invalid_argument& error) {
    copy_text(error.what(), message, message_size);
    return VOLCONTACT_ERROR_SCENE;
  } catch (const std::logic_error& error) {
    copy_text(error.what(), message, message_size);
    return VOLCONTACT_ERROR_STATE;
  } catch (const std::bad_alloc&) {
    copy_text("out of memory", message, message_size);
    return VOLCONTACT_ERROR_MEMORY;
  } catch (const std::exception& error) {
    copy_text(error.what(), message, message_size);
    return VOLCONTACT_ERROR_INTERNAL;
  } catch (...) {
    return VOLCONTACT_ERROR_INTERNAL;
  }
}

void copy_vector(const Vec3& from, double (&to)[3]) { std::copy(from.data(), from.data() + 3, to); }

std::vector<GivenKey> given_keys(const volcontact_key* keys, int count) {
  std::vector<GivenKey> given;
  for (int i = 0; i < count; ++i) {
    const volcontact_key& key = keys[i];
    given.push_back({key.name, {key.numbers, key.numbers + key.count}});
  }
  return given;
}

volcontact_site record_of(const PairContact& pair, PairId id, const SiteReport& report) {
  volcontact_site site{};
  site.pair = id;
  std::tie(site.geom_a, site.geom_b) = std::minmax(pair.geoms.a, pair.geoms.b);
  const double sign = site.geom_a == pair.geoms.a ? 1.0 : -1.0;  // of what is told of a
  site.status = static_cast<int>(report.metrics.status);
  site.volume = report.metrics.volume;
  copy_vector(report.metrics.centroid, site.centroid);
  copy_vector(sign * report.normal, site.normal);
  site.area = report.metrics.area_vector.norm();
  site.depth = report.metrics.depth;
  copy_vector(sign * report.force_on_A, site.force);
  copy_vector(sign * report.torque_on_A, site.torque);
  site.normal_force = report.normal_force;
  site.slip = report.slip.norm();
  site.spin = report.spin;
  site.elastic_energy = report.elastic_energy;
  site.flatness = report.metrics.flatness();
  site.volume_error = report.metrics.volume_error;
  return site;
}

volcontact_contact record_of(const SceneForce& force) {
  volcontact_contact contact{};
  contact.geom_a = force.geom_a;
  contact.geom_b = force.geom_b;
  contact.is_native = force.is_native ? 1 : 0;
  copy_vector(force.position, contact.position);
  copy_vector(force.normal, contact.normal);
  copy_vector(force.force, contact.force);
  copy_vector(force.torque, contact.torque);
  contact.normal_force = force.normal_force;
  return contact;
}

void copy_channels(const ByChannel& from, double (&to)[4]) {
  const double numbers[] = {from.normal, from.roll, from.slide, from.spin};
  std::copy(std::begin(numbers), std::end(numbers), to);
}

constexpr int kMostColumns = 256;

// The site of that number among those of the scratch, with its pair, and with the solids of that
// where they stand for several; null when there are fewer.
struct FoundSite {
  const PairContact* pair = nullptr;
  const VolumeMetrics* metrics = nullptr;
  const GeometricPair* joined = nullptr;
};
FoundSite find_site(const EvaluationScratch& scratch, int site) {
  std::size_t left = static_cast<std::size_t>(site);
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const auto& sites = scratch.reports[k].sites;
    if (left < sites.size()) {
      const JoinedPair* joined = scratch.joined.at(k);
      return {&scratch.pair(k), &sites[left].metrics, joined ? &joined->solids : nullptr};
    }
    left -= sites.size();
  }
  return {};
}

volcontact_surface_size copy_surface(const OverlapSurface& surface, double* columns, int* triangles,
                                     int* rim) {
  for (const auto& column : surface.columns) {
    columns = std::copy(column.low.data(), column.low.data() + 3, columns);
    columns = std::copy(column.high.data(), column.high.data() + 3, columns);
  }
  for (const auto& triangle : surface.triangles) {
    triangles = std::copy(triangle.begin(), triangle.end(), triangles);
  }
  for (const auto& line : surface.rim) rim = std::copy(line.begin(), line.end(), rim);
  return {static_cast<int>(surface.columns.size()), static_cast<int>(surface.triangles.size()),
          static_cast<int>(surface.rim.size())};
}

}  // namespace
}  // namespace volcontact::adaptor

using namespace volcontact::adaptor;

extern "C" {

int volcontact_record_size(const char* name) {
  const std::pair<std::string_view, std::size_t> sizes[] = {
      {"volcontact_site", sizeof(volcontact_site)},
      {"volcontact_contact", sizeof(volcontact_contact)},
      {"volcontact_surface_size", sizeof(volcontact_surface_size)},
      {"volcontact_energy", sizeof(volcontact_energy)},
      {"volcontact_key", sizeof(volcontact_key)},
      {"volcontact_number", sizeof(volcontact_number)},
      {"volcontact_range", sizeof(volcontact_range)},
      {"volcontact_watch", sizeof(volcontact_watch)},
  };
  for (const auto& [record, size] : sizes) {
    if (name && record == name) return static_cast<int>(size);
  }
  return 0;
}

int volcontact_mujoco_version(void) { return mjVERSION_HEADER; }

int volcontact_check_version(char* message, int message_size) {
  return guarded(message, message_size, [] { return 0; });
}

int volcontact_userdata_size(const mjModel* m, char* message, int message_size) {
  return volcontact_userdata_size_with(m, nullptr, 0, message, message_size);
}

int volcontact_userdata_size_with(const mjModel* m, const volcontact_key* keys, int count,
                                  char* message, int message_size) {
  return guarded(message, message_size,
                 [&] { return SceneContact(m, given_keys(keys, count)).layout(m).size(); });
}

int volcontact_reserve(mjModel* m, char* message, int message_size) {
  return volcontact_reserve_with(m, nullptr, 0, message, message_size);
}

int volcontact_reserve_with(mjModel* m, const volcontact_key* keys, int count, char* message,
                            int message_size) {
  const int size = volcontact_userdata_size_with(m, keys, count, message, message_size);
  if (size > 0) m->nuserdata += size;
  return size;
}

int volcontact_attach(mjModel* m, char* message, int message_size) {
  return volcontact_attach_with(m, nullptr, 0, message, message_size);
}

int volcontact_attach_with(mjModel* m, const volcontact_key* keys, int count, char* message,
                           int message_size) {
  return guarded(message, message_size, [&] {
    std::string warnings;
    for (const std::string& warning : attach_scene(m, given_keys(keys, count))) {
      warnings += (warnings.empty() ? "" : "\n") + warning;
    }
    copy_text(warnings, message, message_size);
    install_callback();
    return 0;
  });
}

int volcontact_detach(mjModel* m, char* message, int message_size) {
  return guarded(message, message_size, [&] {
    if (!detach_scene(m)) throw std::logic_error("the model is not attached");
    if (scenes_of_the_callback() == 0 && !attaches_by_itself()) uninstall_callback();
    return 0;
  });
}

int volcontact_is_attached(const mjModel* m) { return is_attached(m) ? 1 : 0; }

int volcontact_is_installed(void) { return callback_is_installed() ? 1 : 0; }

int volcontact_set_auto(int on) {
  return guarded(nullptr, 0, [&] {
    set_attaches_by_itself(on != 0);
    if (on != 0) install_callback();
    if (on == 0 && scenes_of_the_callback() == 0) uninstall_callback();
    return 0;
  });
}

int volcontact_release(const mjModel* m, mjData* d) {
  return guarded(nullptr, 0, [&] {
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    release_contact(*contact, m, d);
    return 0;
  });
}

int volcontact_sites(const mjModel* m, const mjData* d, volcontact_site* sites, int capacity) {
  return guarded(nullptr, 0, [&] {
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    EvaluationScratch& scratch = thread_scratch();
    if (!revisit(*contact, m, d, scratch)) return 0;
    int count = 0;
    for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
      const std::vector<volcontact::SiteReport>& reports = scratch.reports[k].sites;
      for (std::size_t i = 0; i < reports.size(); ++i) {
        const PairId id = scratch.pair_of_site(k, i);
        if (count < capacity) sites[count] = record_of(contact->pair(id), id, reports[i]);
        ++count;
      }
    }
    return count;
  });
}

int volcontact_contacts(const mjModel* m, const mjData* d, volcontact_contact* contacts,
                        int capacity) {
  return guarded(nullptr, 0, [&] {
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    std::vector<SceneForce> forces;
    list_contacts(*contact, m, d, thread_scratch(), forces);
    const std::size_t room = contacts ? static_cast<std::size_t>(std::max(capacity, 0)) : 0;
    for (std::size_t i = 0; i < std::min(room, forces.size()); ++i) {
      contacts[i] = record_of(forces[i]);
    }
    return static_cast<int>(forces.size());
  });
}

int volcontact_site_surface(const mjModel* m, const mjData* d, int site, int resolution,
                            double* columns, int* triangles, int* rim,
                            volcontact_surface_size* size) {
  return guarded(nullptr, 0, [&] {
    *size = {};
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    if (site < 0 || resolution < 2 || resolution > kMostColumns) {
      return static_cast<int>(VOLCONTACT_ERROR_SCENE);
    }
    EvaluationScratch& scratch = thread_scratch();
    if (!revisit(*contact, m, d, scratch)) return static_cast<int>(VOLCONTACT_ERROR_SCENE);
    const FoundSite found = find_site(scratch, site);
    if (!found.pair) return static_cast<int>(VOLCONTACT_ERROR_SCENE);
    const volcontact::GeometricPair& solids =
        found.joined ? *found.joined : found.pair->model.pairs().front();
    const volcontact::OverlapSurface surface = volcontact::overlap_surface(
        solids.a, pose_of_geom(d, found.pair->frame_a) * solids.X_Aa, solids.b,
        pose_of_geom(d, found.pair->frame_b) * solids.X_Bb, *found.metrics, resolution);
    *size = copy_surface(surface, columns, triangles, rim);
    return 0;
  });
}

int volcontact_update_touch(const mjModel* m, mjData* d) {
  return guarded(nullptr, 0, [&] {
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    update_touch_sensors(*contact, m, d, thread_scratch());
    return 0;
  });
}

int volcontact_get_energy(const mjModel* m, const mjData* d, volcontact_energy* energy) {
  return guarded(nullptr, 0, [&] {
    const SceneContact* contact = contact_of(m);
    if (!contact) return static_cast<int>(VOLCONTACT_ERROR_STATE);
    const EnergyAccount account = volcontact::adaptor::energy(*contact, m, d);
    energy->elastic = account.elastic;
    copy_channels(account.dissipated, energy->dissipated);
    copy_channels(account.power, energy->power);
    energy->work = account.work;
    energy->numerical = account.numerical;
    energy->unpaid = account.unpaid;
    energy->driven = account.driven;
    energy->made = account.made;
    energy->released = account.released;
    energy->owed = account.owed;
    energy->dropped = dropped(*contact, m, d);
    energy->forgotten = forgotten(*contact, m, d);
    return 0;
  });
}

int volcontact_step_watched(const mjModel* m, mjData* d, int steps, volcontact_watch* watch) {
  return guarded(nullptr, 0, [&] { return step_watched(m, d, steps, *watch); });
}

int volcontact_read_numbers(const mjModel* m, const mjData* d, const volcontact_watch* watch,
                            const volcontact_number* numbers, int count, double* values) {
  return guarded(nullptr, 0, [&] {
    for (int i = 0; i < count; ++i) values[i] = read_number(m, d, numbers[i], watch);
    return count;
  });
}

int volcontact_describe(const mjModel* m, char* text, int capacity, char* message,
                        int message_size) {
  return guarded(message, message_size, [&] {
    const SceneContact* contact = contact_of(m);
    const std::string description = contact ? describe(m, *contact) : describe(m, SceneContact(m));
    return copy_text(description, text, capacity);
  });
}

int volcontact_pair_text(const mjModel* m, long long pair, char* text, int capacity, char* message,
                         int message_size) {
  return guarded(message, message_size, [&] {
    const SceneContact* contact = contact_of(m);
    std::optional<SceneContact> own;
    if (!contact) contact = &own.emplace(m);
    GeomPair geoms;
    volcontact::require(contact->rules().find(pair, geoms),
                        "pair " + std::to_string(pair) + " is none of the " +
                            std::to_string(contact->rules().count()) + " of the scene");
    return copy_text(volcontact::text_of(contact->make_pair(geoms).model), text, capacity);
  });
}

int volcontact_live_error(const mjModel* m, char* message, int message_size) {
  return guarded(nullptr, 0, [&] { return copy_text(live_error(m), message, message_size); });
}

}  // extern "C"

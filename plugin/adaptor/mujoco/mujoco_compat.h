// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

// All that differs between the releases of MuJoCo, and nothing else. mjVERSION_HEADER grows with
// every release: 222 is 2.2.2, 340 is 3.4.0, 4000000 is 4.0.0.

// Functions that MuJoCo's library has but its headers do not; null where it has them no more. The
// derivative of actuator and passive forces, and of the bias if wished, by velocities goes into
// mjData.qDeriv; of a body that flies alone the matrix that `implicitfast` divides by; the bias of
// tendons that have inertia, added to that of the bodies.
extern "C" {
[[gnu::weak]] void mjd_smooth_vel(const mjModel* m, mjData* d, int with_bias);
[[gnu::weak]] int mjd_freeMhat(const mjModel* m, const mjData* d, int joint, mjtNum step,
                               mjtNum out[36]);
[[gnu::weak]] void mj_tendonBias(const mjModel* m, mjData* d, mjtNum* qfrc);
#if mjVERSION_HEADER >= 4000000
[[gnu::weak]] void mj_updateSleep(const mjModel* m, mjData* d);
#endif
#if mjVERSION_HEADER < 233
[[gnu::weak]] void mj_makeMSparse(const mjModel* m, mjData* d, int* rownnz, int* rowadr,
                                  int* colind);
#endif
}

namespace volcontact::adaptor {

/// The two bodies of an <exclude>, lower id first, from the number under which it is stored.
inline std::pair<int, int> excluded_bodies(int signature) {
#if mjVERSION_HEADER < 300
  return {(signature >> 16) - 1, (signature & 0xffff) - 1};
#else
  return {signature >> 16, signature & 0xffff};
#endif
}

/// Whether contacts between geoms come from their bit masks, and whether from explicit <pair>s.
inline bool collides_by_masks([[maybe_unused]] const mjModel* m) {
#if mjVERSION_HEADER < 300
  return m->opt.collision != mjCOL_PAIR;
#else
  return true;
#endif
}
inline bool collides_by_pairs([[maybe_unused]] const mjModel* m) {
#if mjVERSION_HEADER < 300
  return m->opt.collision != mjCOL_DYNAMIC;
#else
  return true;
#endif
}

/// The flags that make MuJoCo leave out the passive callback without a word; empty when it is
/// called.
inline std::string flags_that_skip_passive(const mjModel* m) {
#if mjVERSION_HEADER <= 335
  return m->opt.disableflags & mjDSBL_PASSIVE ? "passive=\"disable\"" : "";
#else
  constexpr int kBoth = mjDSBL_SPRING | mjDSBL_DAMPER;
  return (m->opt.disableflags & kBoth) == kBoth ? "spring=\"disable\" damper=\"disable\"" : "";
#endif
}

/// Whether the integrator takes the damping of the degrees of freedom implicitly: divides by
/// M + h B.
inline bool damps_implicitly(const mjModel* m) {
  if (m->opt.integrator == mjINT_RK4) return false;
#if mjVERSION_HEADER <= 335
  if (m->opt.disableflags & mjDSBL_PASSIVE) return false;
#else
  if (m->opt.disableflags & mjDSBL_DAMPER) return false;
#endif
#if mjVERSION_HEADER >= 300
  if (m->opt.integrator == mjINT_EULER && (m->opt.disableflags & mjDSBL_EULERDAMP)) return false;
#endif
  return std::any_of(m->dof_damping, m->dof_damping + m->nv, [](double b) { return b > 0.0; });
}

/// Whether the constraint solver takes the matrix of the integrator for the mass matrix.
inline bool solves_with_step_matrix([[maybe_unused]] const mjModel* m) {
#if mjVERSION_HEADER >= 3013000
  return m->opt.integrator == mjINT_DISCRETE;
#else
  return false;
#endif
}

/// Whether `discrete` may add more to that matrix than the damping of the degrees of freedom.
inline bool adds_to_step_matrix(const mjModel* m) {
  return m->nu > 0 || m->ntendon > 0 || m->opt.density > 0.0 || m->opt.viscosity > 0.0 ||
         std::any_of(m->jnt_stiffness, m->jnt_stiffness + m->njnt,
                     [](double k) { return k != 0.0; });
}

/// What the matrix of `discrete` has beside the mass matrix, by degrees of freedom: on the
/// diagonal, for fluids where the mass matrix has entries (null without), and the stiffness k h
/// whose product with the velocity goes off the forces. All null where there is nothing.
struct StepDiagonal {
  const mjtNum* added = nullptr;
  const mjtNum* fluid = nullptr;
  const mjtNum* stiffness = nullptr;
};
inline StepDiagonal step_diagonal([[maybe_unused]] const mjData* d) {
#if mjVERSION_HEADER >= 3013000
  if (d->efm_active != 0) return {d->efm_diag, d->efm_fluid, d->efm_ck};
#endif
  return {};
}

/// And besides, for tendons and actuators: calls use(scale, stiffness, dofs, numbers) where the
/// matrix has scale * J' J, with J of these degrees of freedom, and the forces -stiffness * J' J v.
template <typename Use>
void for_each_step_row([[maybe_unused]] const mjModel* m, [[maybe_unused]] const mjData* d,
                       [[maybe_unused]] Use use) {
#if mjVERSION_HEADER >= 3013000
  if (d->efm_active == 0) return;
  const auto part = [](const auto* of, int begin, int count) {
    return std::span(of + begin, static_cast<std::size_t>(count));
  };
  for (int i = 0; i < d->nefmT; ++i) {
    const int id = d->efm_tid[i], begin = m->ten_J_rowadr[id], count = m->ten_J_rownnz[id];
    use(d->efm_ts[i], d->efm_tk[i], part(m->ten_J_colind, begin, count),
        part(d->ten_J, begin, count));
  }
  for (int i = 0; i < d->nefmA; ++i) {
    const int id = m->actuator_outadr[d->efm_aid[i]];
    const int begin = d->moment_rowadr[id], count = d->moment_rownnz[id];
    use(d->efm_as[i], d->efm_ak[i], part(d->moment_colind, begin, count),
        part(d->actuator_moment, begin, count));
  }
#endif
}

/// What the integrator takes implicitly of the forces by velocities.
enum class Damping { kNone, kOfJoints, kAllSymmetric, kAll };

/// Prepares what `for_row_of_damping` reads. Overwrites mjData.qDeriv, as the integrator will.
inline Damping make_damping(const mjModel* m, mjData* d) {
  const bool all = m->opt.integrator == mjINT_IMPLICIT;
#if mjVERSION_HEADER >= 233
  const bool fast = m->opt.integrator != mjINT_EULER && m->opt.integrator != mjINT_RK4 && !all;
#else
  constexpr bool fast = false;
  if (all && mj_makeMSparse) mj_makeMSparse(m, d, d->D_rownnz, d->D_rowadr, d->D_colind);
#endif
  if ((all || fast) && mjd_smooth_vel) {
    mjd_smooth_vel(m, d, all);
    return all ? Damping::kAll : Damping::kAllSymmetric;
  }
  return damps_implicitly(m) ? Damping::kOfJoints : Damping::kNone;
}

/// Calls use(k, B_ik) for degree of freedom i, where the integrator divides by M + h B. Of a
/// symmetric B only for what carries i.
template <typename Use>
void for_row_of_damping(const mjModel* m, const mjData* d, Damping damping, int i, Use use) {
  if (damping == Damping::kNone) return;
  if (damping == Damping::kOfJoints) return use(i, m->dof_damping[i]);
#if mjVERSION_HEADER >= 336
  const int *counts = m->D_rownnz, *begins = m->D_rowadr, *columns = m->D_colind;
#else
  const int *counts = d->D_rownnz, *begins = d->D_rowadr, *columns = d->D_colind;
#endif
  for (int at = begins[i]; at < begins[i] + counts[i]; ++at) {
    if (damping == Damping::kAll || columns[at] <= i) use(columns[at], -d->qDeriv[at]);
  }
}

/// The matrix that `implicitfast` and `discrete` divide by for a body that flies alone, where they
/// know one, into `out`, 6 x 6; after `make_damping`.
inline bool matrix_of_free_body(const mjModel* m, const mjData* d, Damping damping, int joint,
                                double* out) {
  return damping == Damping::kAllSymmetric && m->jnt_type[joint] == mjJNT_FREE && mjd_freeMhat &&
         mjd_freeMhat(m, d, joint, m->opt.timestep, out) != 0;
}

/// Calls use(k, address) for degree of freedom i and each k that carries it, with where the mass
/// matrix has M_ik.
template <typename Use>
void for_entry_of_mass(const mjModel* m, int i, Use use) {
#if mjVERSION_HEADER < 3009000
  int address = m->dof_Madr[i];
  for (int k = i; k >= 0; k = m->dof_parentid[k]) use(k, address++);
#else
  const int begin = m->M_rowadr[i], end = begin + m->M_rownnz[i];
  for (int address = begin; address < end; ++address) use(m->M_colind[address], address);
#endif
}

/// Calls use(k, M_ik) for degree of freedom i, and for each k that carries it.
template <typename Use>
void for_row_of_mass(const mjModel* m, const mjData* d, int i, Use use) {
#if mjVERSION_HEADER < 3009000
  const mjtNum* numbers = d->qM;
#else
  const mjtNum* numbers = d->M;
#endif
  for_entry_of_mass(m, i, [&](int k, int address) { use(k, numbers[address]); });
}

/// Calls use(k, J_ik) for row i of the Jacobian of MuJoCo's constraints; zeros may be left out.
template <typename Use>
void for_row_of_constraint(const mjModel* m, const mjData* d, int i, Use use) {
  if (mj_isSparse(m)) {
    const int begin = d->efc_J_rowadr[i], end = begin + d->efc_J_rownnz[i];
    for (int at = begin; at < end; ++at) use(d->efc_J_colind[at], d->efc_J[at]);
  } else {
    for (int k = 0; k < m->nv; ++k) use(k, d->efc_J[i * static_cast<int>(m->nv) + k]);
  }
}

/// Whether bodies may fall asleep.
inline bool sleep_enabled([[maybe_unused]] const mjModel* m) {
#if mjVERSION_HEADER >= 340
  return (m->opt.enableflags & mjENBL_SLEEP) != 0;
#else
  return false;
#endif
}

/// Whether we can wake them in this release.
inline bool can_wake() {
#if mjVERSION_HEADER >= 4000000
  return mj_updateSleep != nullptr;
#else
  return false;
#endif
}

inline bool has_flexes([[maybe_unused]] const mjModel* m) {
#if mjVERSION_HEADER >= 300
  return m->nflex > 0;
#else
  return false;
#endif
}

/// The text with "?" for what steers a terminal: names of a file may have it.
inline std::string printable(std::string text) {
  bool leads = false;  // the byte before begins a character between U+0080 and U+00BF
  for (char& letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool steers = byte < 0x20 || byte == 0x7f || (leads && byte >= 0x80 && byte < 0xa0);
    leads = byte == 0xc2;
    if (steers && letter != '\n' && letter != '\t') letter = '?';
  }
  return text;
}

/// Writes a MuJoCo warning; its function became printf-like on the way.
template <typename Warn = decltype(&mju_warning)>
void write_warning(const std::string& text, Warn warn = &mju_warning) {
  const std::string seen = printable(text);
  if constexpr (std::is_same_v<Warn, void (*)(const char*)>) {
    warn(seen.c_str());
  } else {
    warn("%s", seen.c_str());
  }
}

/// Distance along a ray to a geom of a simple type, 0 from within, negative when it misses; its
/// function got one more argument on the way.
template <typename Ray = decltype(&mju_rayGeom)>
double ray_to_zone(const mjtNum* position, const mjtNum* rotation, const mjtNum* size,
                   const mjtNum* point, const mjtNum* direction, int type, Ray ray = &mju_rayGeom) {
  if constexpr (std::is_invocable_v<Ray, const mjtNum*, const mjtNum*, const mjtNum*, const mjtNum*,
                                    const mjtNum*, int>) {
    return ray(position, rotation, size, point, direction, type);
  } else {
    return ray(position, rotation, size, point, direction, type, nullptr);
  }
}

/// "2.2.2" from 222, "4.0.0" from 4000000.
inline std::string version_text(int version) {
  const int base = version < 1000 ? 10 : 1000;
  return std::to_string(version / base / base) + "." + std::to_string(version / base % base) + "." +
         std::to_string(version % base);
}

/// The object's name, or "geom 3" for one that has none.
inline std::string label(const mjModel* m, mjtObj type, int id) {
  const char* name = mj_id2name(m, type, id);
  if (name && *name) return name;
  return std::string(type == mjOBJ_GEOM   ? "geom "
                     : type == mjOBJ_BODY ? "body "
                                          : "object ") +
         std::to_string(id);
}

}  // namespace volcontact::adaptor

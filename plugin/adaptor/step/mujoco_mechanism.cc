// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/mujoco_mechanism.h"

#include <algorithm>

namespace volcontact::adaptor {

MechanismTrees trees_of(const mjModel* m) {
  constexpr int kNone = MechanismTrees::kNone;
  MechanismTrees out;
  std::vector<int> tree_of_root(size(static_cast<int>(m->nbody)), kNone);
  for (int dof = 0; dof < m->nv; ++dof) {
    const int root = m->body_rootid[m->dof_bodyid[dof]];
    int& tree = tree_of_root[size(root)];
    if (tree == kNone) {
      tree = static_cast<int>(out.trees.size());
      out.trees.push_back({dof, dof});
      out.root.push_back(root);
      out.mass.push_back(m->body_subtreemass[root]);
    }
    out.trees[size(tree)].end = dof + 1;
    out.tree_of_dof.push_back(tree);
    const int carrier = m->dof_parentid[dof];
    out.carrier.push_back(carrier);
    out.depth.push_back(carrier == kNone ? 0 : out.depth[size(carrier)] + 1);
  }
  for (int body = 0; body < m->nbody; ++body) {
    const bool moves = m->body_weldid[body] != 0;
    out.tree_of_body.push_back(moves ? tree_of_root[size(m->body_rootid[body])] : kNone);
    int carried_by = body;
    while (carried_by > 0 && m->body_dofnum[carried_by] == 0) {
      carried_by = m->body_parentid[carried_by];
    }
    const int count = m->body_dofnum[carried_by];
    out.last_dof.push_back(count > 0 ? m->body_dofadr[carried_by] + count - 1 : kNone);
  }
  return out;
}

double fall_of(const mjModel* m) { return m->opt.timestep * Vec3::from(m->opt.gravity).norm(); }

MujocoMechanism::MujocoMechanism(const mjModel* m, mjData* d, const MechanismTrees& of_model,
                                 const StepMetric& metric)
    : m_(m), d_(d), metric_(metric), damping_(make_damping(m, d)) {
  trees = &of_model;
  step = m->opt.timestep;
  fall = fall_of(m);
  speeds = d->qvel;
  motions = d->cdof;
  motion_rates = d->cdof_dot;
  origins = d->subtree_com;
  twists = d->cvel;
}

// The mass matrix has fewer numbers where bodies are simple.
void MujocoMechanism::mass(int dof, double* row) const {
  const std::vector<int>& depth = trees->depth;
  for_row_of_mass(m_, d_, dof, [&](int other, double mass) {
    row[depth[size(dof)] - depth[size(other)]] = mass;
  });
}

void MujocoMechanism::damping(std::span<const int> dofs, std::vector<DofEntry>& out) const {
  for (const int dof : dofs) dampen(dof, out);
  if (damping_ != Damping::kAllSymmetric) return;
  for (const int dof : dofs) {
    const DofRange& tree = trees->trees[size(trees->tree_of_dof[size(dof)])];
    if (tree.begin == dof && tree.size() == 6) fly(dof, out);
  }
}

void MujocoMechanism::dampen(int dof, std::vector<DofEntry>& out) const {
  const auto put = [&](int other, double value) {
    out.push_back({dof, other, value});
    if (damping_ == Damping::kAllSymmetric) out.push_back({other, dof, value});
  };
  if (!metric_.is_known()) {
    for_row_of_damping(m_, d_, damping_, dof, [&](int other, double b) { put(other, step * b); });
    return;
  }
  if (!metric_.fluid()) return put(dof, metric_.diagonal(dof));
  for_entry_of_mass(m_, dof, [&](int other, int address) {
    put(other, metric_.fluid()[address] + (other == dof ? metric_.diagonal(dof) : 0.0));
  });
}

// In place of the damping of a body that flies alone, where the integrator has a matrix for it.
void MujocoMechanism::fly(int dof, std::vector<DofEntry>& out) const {
  double matrix[36], mass[36] = {};
  for (int i = 0; i < 6; ++i) {
    if (metric_.is_held(dof + i)) return;
  }
  const mjData* made = metric_.is_known() ? metric_.ahead() : d_;
  if (!matrix_of_free_body(m_, made, damping_, m_->dof_jntid[dof], matrix)) return;
  for (int i = 0; i < 6; ++i) {
    for_row_of_mass(m_, d_, dof + i, [&](int other, double value) {
      mass[6 * i + other - dof] = mass[6 * (other - dof) + i] = value;
    });
  }
  for (int i = 0; i < 36; ++i) {
    out.push_back({dof + i / 6, dof + i % 6, matrix[i] - mass[i]});
  }
}

void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out) {
  const int nv = static_cast<int>(m->nv);
  out.resize(size(nv));
  mj_rne(m, d, 0, out.data());
  if (m->ntendon > 0 && mj_tendonBias) mj_tendonBias(m, d, out.data());
  const bool actuated = m->nu > 0;
  if (actuated) mj_fwdActuation(m, d);
  for (int i = 0; i < nv; ++i) {
    double& force = out[size(i)];
    force = d->qfrc_passive[i] - force + user_qfrc[i];
    if (actuated) force += d->qfrc_actuator[i];
  }
  for (int body = 1; body < m->nbody; ++body) {
    const double* load = user_xfrc + 6 * body;
    if (std::all_of(load, load + 6, [](double x) { return x == 0.0; })) continue;
    mj_applyFT(m, d, load, load + 3, d->xipos + 3 * body, body, out.data());
  }
}

}  // namespace volcontact::adaptor

/* SPDX-License-Identifier: Apache-2.0 */
/* A ball falls on a floor, bounces and comes to rest: the contact model container in a simulator of
 * ten lines. Checks what is known in closed form. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "c_api/volcontact.h"

static const double kPi = 3.14159265358979323846;

static void need(int code, const char* what) {
  if (code >= 0) return;
  fprintf(stderr, "%s: error %d: %s\n", what, code, vc_error());
  exit(1);
}

static void near(double value, double expected, double relative, const char* what) {
  if (fabs(value - expected) <= relative * fabs(expected)) return;
  fprintf(stderr, "%s: %.17g, expected %.17g\n", what, value, expected);
  exit(1);
}

static vc_model* ball_on_floor(double radius, double stiffness, double damping) {
  vc_solid *ball = NULL, *floor_solid = NULL;
  vc_model* model = NULL;
  need(vc_solid_create("sphere", &ball), "sphere");
  need(vc_solid_set(ball, "radius", &radius, 1), "radius");
  need(vc_solid_create("half_space", &floor_solid), "half_space");
  need(vc_model_create(&model), "model");
  need(vc_model_add_pair(model, ball, NULL, floor_solid, NULL), "pair");
  need(vc_model_choose(model, "friction_law", "bristle"), "friction_law");
  need(vc_model_set(model, "stiffness", &stiffness, 1), "stiffness");
  need(vc_model_set(model, "damping", &damping, 1), "damping");
  vc_solid_free(ball);
  vc_solid_free(floor_solid);
  return model;
}

static void set_identity(double* pose) {
  int i;
  for (i = 0; i < 16; ++i) pose[i] = i % 5 == 0 ? 1.0 : 0.0;
}

int main(void) {
  const double radius = 0.05, mass = 1.0, gravity = 9.81, stiffness = 1e8, step = 1e-5;
  double height = 0.1, speed = 0.0, depth, volume, below;
  double state[256];
  int i, size;
  vc_motion motion;
  vc_result result;
  vc_site site;
  vc_model* model = ball_on_floor(radius, stiffness, 2.0);
  vc_workspace* workspace = NULL;

  need(vc_check_version(VC_VERSION), "version");
  need(vc_workspace_create(&workspace), "workspace");
  size = vc_model_state_size(model, 4);
  need(size, "state size");
  if (size == 0 || size > 256) return 1;
  memset(state, 0, sizeof state);
  memset(&motion, 0, sizeof motion);
  set_identity(motion.X_WA);
  set_identity(motion.X_WB);

  /* Semi-implicit Euler; every step is accepted. */
  for (i = 0; i < 200000; ++i) {
    motion.X_WA[11] = height;
    motion.V_WA[5] = speed;
    need(vc_evaluate(model, workspace, &motion, state, state, size, step, &result), "evaluate");
    speed += step * (result.force_on_a[2] / mass - gravity);
    height += step * speed;
  }

  /* At rest the weight is carried: k V = m g, V the cap of the sphere below the floor. */
  depth = radius - height;
  volume = kPi * depth * depth * (3.0 * radius - depth) / 3.0;
  near(stiffness * volume, mass * gravity, 1e-6, "force at rest");
  near(result.metrics.volume, volume, 1e-9, "volume");
  near(result.force_on_b[2], -result.force_on_a[2], 0.0, "action and reaction");
  if (result.sites != 1 || vc_sites(workspace, &site, 1) != 1) return 1;
  /* Centroid of a spherical cap, measured from the centre: 3 (2r - h)^2 / (4 (3r - h)). */
  below = 0.75 * (2.0 * radius - depth) * (2.0 * radius - depth) / (3.0 * radius - depth);
  near(site.metrics.centroid[2], height - below, 1e-6, "centroid");
  vc_workspace_free(workspace);
  vc_model_free(model);
  printf("the ball rests %.9f m deep\n", depth);
  return 0;
}

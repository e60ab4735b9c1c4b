/* SPDX-License-Identifier: Apache-2.0 */
#ifndef VOLCONTACT_C_API_VOLCONTACT_H_
#define VOLCONTACT_C_API_VOLCONTACT_H_

/* The contact model container for any simulation environment, in plain C: solids, pairs and laws
 * by name, poses and twists in, wrenches, metrics and states out. Needs no MuJoCo and no Python.
 * docs/c_container.md explains it with an example.
 *
 * Units are SI. A pose X_AB is a row-major 4x4 matrix, double[16], that maps points of frame B to
 * frame A. A twist is an angular velocity [rad/s], then the velocity of the frame's origin [m/s],
 * in the world frame. Forces are those on A where nothing else is said.
 *
 * Functions return a number >= 0, or a negative VC_ERROR_... . vc_error() then says what is wrong,
 * where, what is allowed and what to do. A call that fails changes nothing.
 *
 * Threads: calls on different objects may run at once. Any number of threads may evaluate one
 * model at once, each with a workspace and state of its own. Whoever changes a model must be alone
 * with it. Results do not depend on threads or on earlier calls, to the bit. */

#if defined(_WIN32)
#if defined(VC_BUILDS_LIBRARY)
#define VC_API __declspec(dllexport)
#else
#define VC_API __declspec(dllimport)
#endif
#else
#define VC_API __attribute__((visibility("default")))
#endif

/* Of this header: 10000 times major, 100 times minor, patch. While major is 0 another minor is
 * another interface. */
#define VC_VERSION 100

#ifdef __cplusplus
extern "C" {
#endif

/* What a function returns when it fails. */
enum {
  VC_ERROR_ARGUMENT = -1, /* a value, name, pose or state that cannot be used */
  VC_ERROR_VERSION = -2,  /* the library is not the one of the header */
  VC_ERROR_MEMORY = -3,   /* out of memory */
  VC_ERROR_RESULT = -4,   /* a force was no finite number; the result is all zero */
  VC_ERROR_INTERNAL = -5  /* a fault of the library */
};

/* What the numbers of a vc_metrics are worth. */
enum {
  VC_OK = 0,          /* the volume is within volume_error */
  VC_CONTAINED = 1,   /* one solid inside the other: there is no direction to push */
  VC_APPROXIMATE = 2, /* volume_error exceeds what the tolerance asks */
  VC_UNBOUNDED = 3    /* the overlap has no finite volume: zero metrics */
};

/* The volume common to two solids. From vc_evaluate: in the world frame, about the world origin;
 * from vc_interference: in A's frame, about its origin. */
typedef struct vc_metrics {
  double volume;         /* V [m^3] */
  double centroid[3];    /* [m] */
  double inertia[9];     /* about the centroid, unit density [m^5] */
  double area_vector[3]; /* outward normal of A over A's surface inside B = dV/dx of A [m^2] */
  double area_moment[3]; /* its moment about the origin = dV/dtheta of A [m^3] */
  double area;           /* of A's surface inside B [m^2] */
  double counter_area;   /* of B's surface inside A [m^2] */
  double depth_moment;   /* integral of depth over the volume along the normal [m^4] */
  double depth;          /* longest column along the normal [m] */
  double flatness;       /* 1 for a flat patch, small where the normal means little [-] */
  double volume_error;   /* bound or estimate of the error of V [m^3] */
  int status;            /* VC_OK, ... */
} vc_metrics;

/* One contact site: a connected region of the overlap of one pair. World frame. Channels of power
 * in the order normal, roll, slide, spin. A host of flexible bodies applies the force and the
 * torque at the centroid, or spreads them over the patch, of which second_moment tells how far it
 * reaches; the sites together make the wrenches of vc_result. */
typedef struct vc_site {
  vc_metrics metrics;
  double normal[3];        /* on A, from B to A */
  double normal_force;     /* [N] */
  double force[3];         /* on A, at the centroid [N] */
  double torque[3];        /* on A, about the centroid [N m] */
  double approach_speed;   /* > 0 while approaching [m/s] */
  double slip[3];          /* tangential velocity of A against B at the centroid [m/s] */
  double spin;             /* of A against B about the normal [rad/s] */
  double elastic_energy;   /* [J] */
  double power[4];         /* dissipated [W] */
  double second_moment[9]; /* integral of r r^T dV, r from the centroid [m^5] */
  int pair;                /* index of the pair in the model */
} vc_site;

/* How the two bodies stand and move. */
typedef struct vc_motion {
  double X_WA[16]; /* pose of body A in the world */
  double X_WB[16]; /* pose of body B */
  double V_WA[6];  /* twist of body A at its origin, in the world frame */
  double V_WB[6];  /* twist of body B */
} vc_motion;

/* What an evaluation gives, summed over all sites. World frame. */
typedef struct vc_result {
  double force_on_a[3];  /* [N] */
  double torque_on_a[3]; /* about A's origin [N m] */
  double force_on_b[3];  /* [N] */
  double torque_on_b[3]; /* about B's origin [N m] */
  double elastic_energy; /* [J] */
  double power[4];       /* dissipated [W] */
  vc_metrics metrics;    /* of all sites together */
  int sites;             /* vc_sites gives them one by one */
  int forgotten;         /* sites for which next_state had no room: new ones at the next call */
} vc_result;

/* How the wrenches change with the motion. 12 by 12, row by row, world frame: rows are the torque
 * and force on A, then those on B; columns the turn [rad] and displacement [m] of A's frame, then
 * of B's, or their speeds. Analytic and at fixed states: the patch is taken as flat
 * (docs/theory.md, "Stiffness of a site"). What bristles hold against a way since `state` is in it
 * where that way is, so with elapsed > 0. */
typedef struct vc_tangent {
  double by_motion[144]; /* dW/dx */
  double by_speed[144];  /* dW/dv */
} vc_tangent;

/* A solid in a frame of its own. */
typedef struct vc_solid vc_solid;
/* Pairs of solids on two bodies, with their laws. */
typedef struct vc_model vc_model;
/* What an evaluation works in. */
typedef struct vc_workspace vc_workspace;

/* VC_VERSION of the library. */
VC_API int vc_version(void);

/* 0, or VC_ERROR_VERSION where a program compiled with that VC_VERSION cannot use this library. */
VC_API int vc_check_version(int version_of_header);

/* The same, and whether the records of the program have the size they have in the library: another
 * compiler or packing is found before it does harm. VC_CHECK() fills in the sizes. */
VC_API int vc_check_layout(int version_of_header, int motion_size, int site_size, int result_size,
                           int tangent_size);
#define VC_CHECK()                                                          \
  vc_check_layout(VC_VERSION, (int)sizeof(vc_motion), (int)sizeof(vc_site), \
                  (int)sizeof(vc_result), (int)sizeof(vc_tangent))

/* What the last failed call of this thread has to say; valid until its next failed call. */
VC_API const char* vc_error(void);

/* ---- Solids. A pair keeps a copy: a solid may be freed or changed once it is in one. ----------
 */

/* A solid of a simple shape with default parameters: half_space, sphere, ellipsoid, capsule,
 * cylinder, frustum, box, rounded_box, torus. docs/components.md has their parameters. */
VC_API int vc_solid_create(const char* shape, vc_solid** solid);

/* The solid inside a closed triangle mesh, convex or not. `vertices` has 3 numbers each [m],
 * `triangles` 3 indices from 0 each, counterclockwise seen from outside. */
VC_API int vc_solid_create_mesh(const double* vertices, int vertex_count, const int* triangles,
                                int triangle_count, vc_solid** solid);

/* The convex hull of points, 3 numbers each [m]. */
VC_API int vc_solid_create_polytope(const double* points, int point_count, vc_solid** solid);

/* "union", "intersection" or "difference" of a, and b at the pose X_AB (null: the same frame). The
 * new solid has a's frame. */
VC_API int vc_solid_combine(const char* operation, const vc_solid* a, const vc_solid* b,
                            const double* X_AB, vc_solid** solid);

/* A solid from a line of text, and its text: written and read, it is the same to the bit.
 * vc_solid_text writes up to `capacity` characters with the final zero and returns the length of
 * the whole text without it. docs/c_container.md, "A model as text". */
VC_API int vc_solid_create_text(const char* text, vc_solid** solid);
/* The text of a solid. */
VC_API int vc_solid_text(const vc_solid* solid, char* text, int capacity);

/* Sets a parameter of a simple shape: 1 or 3 numbers. */
VC_API int vc_solid_set(vc_solid* solid, const char* name, const double* numbers, int count);

/* Writes up to `capacity` numbers of a parameter and returns how many it has. */
VC_API int vc_solid_get(const vc_solid* solid, const char* name, double* numbers, int capacity);

/* Of the solid itself, in its frame: volume, centroid, inertia. */
VC_API int vc_solid_metrics(const vc_solid* solid, vc_metrics* metrics);

/* Frees it; null is nothing to free. */
VC_API void vc_solid_free(vc_solid* solid);

/* ---- Models: pairs of solids x normal law x friction law ------------------------------------- */

/* A model without pairs, of normal law hunt_crossley and without friction. */
VC_API int vc_model_create(vc_model** model);

/* A whole model from text, and its text, as above. */
VC_API int vc_model_create_text(const char* text, vc_model** model);
/* The text of a model. */
VC_API int vc_model_text(const vc_model* model, char* text, int capacity);

/* Adds a pair: solid a fixed on body A at X_Aa, solid b on body B at X_Bb (null: identity). Returns
 * the pair's index. */
VC_API int vc_model_add_pair(vc_model* model, const vc_solid* a, const double* X_Aa,
                             const vc_solid* b, const double* X_Bb);

/* Chooses a word: normal_law, friction_law (or "none"), coupling and other choices of the laws,
 * rolling (on, off), engine, formulation. Another law starts with its default parameters. */
VC_API int vc_model_choose(vc_model* model, const char* name, const char* word);

/* Writes the word in force with a final zero and returns its length. */
VC_API int vc_model_chosen(const vc_model* model, const char* name, char* word, int capacity);

/* Sets numbers: parameters of the two laws by their names (stiffness, friction, ...), tolerance,
 * share_of_a, mass (the reduced mass of the two bodies, of which sticking friction takes its
 * damping; 0: not known), threads, and of pair i "pair/i/a/<parameter of the shape>",
 * "pair/i/a/pose" (16 numbers) and the same with b. */
VC_API int vc_model_set(vc_model* model, const char* name, const double* numbers, int count);

/* Writes up to `capacity` numbers of a parameter and returns how many it has. */
VC_API int vc_model_get(const vc_model* model, const char* name, double* numbers, int capacity);

/* All that can be set or chosen, a line each: name, unit, allowed range or words, present value,
 * parted by tabs. Writes up to `capacity` characters with the final zero and returns the length of
 * the whole text without it. */
VC_API int vc_model_parameters(const vc_model* model, char* text, int capacity);

/* Length of a state array with room for that many contact sites; 0 when the laws keep nothing.
 * Ask again after choosing a law or setting a parameter. */
VC_API int vc_model_state_size(const vc_model* model, int sites);

/* What the laws keep for each site, a line each: name, unit, first number within the site's row,
 * count of numbers, parted by tabs. The row of site i starts at state[2 + i * row], where row is
 * state[1] and state[0] is the count of sites. */
VC_API int vc_model_states(const vc_model* model, char* text, int capacity);

/* Frees it; null is nothing to free. */
VC_API void vc_model_free(vc_model* model);

/* ---- Evaluation ------------------------------------------------------------------------------ */

/* Scratch memory, and the sites of the last evaluation; one per thread. Holds nothing that could
 * change a value. A warm evaluation allocates nothing. */
VC_API int vc_workspace_create(vc_workspace** workspace);
/* Frees it; null is nothing to free. */
VC_API void vc_workspace_free(vc_workspace* workspace);

/* Wrenches on both bodies.
 *
 * state       what the sites kept at the last accepted time; null or all zero: all sites are new
 * next_state  filled with what they keep now; may be null, or `state` itself
 * state_size  length of both arrays, from vc_model_state_size
 * elapsed     time since `state` [s]
 *
 * May be called any number of times for one step: each call starts from `state`. When a time step
 * is accepted, next_state becomes state. */
VC_API int vc_evaluate(const vc_model* model, vc_workspace* workspace, const vc_motion* motion,
                       const double* state, double* next_state, int state_size, double elapsed,
                       vc_result* result);

/* For a solver that integrates the states of the laws along with the motion. The states of the rows
 * are those of now; where the bodies stood when the rows were written only says which site is
 * which. The wrenches follow from these states, and `next_state` gets the rows of the sites of
 * now. `rates`, of the same length, gets the time derivative of every state of `next_state`, and 0
 * elsewhere. Costs three evaluations where the laws keep something and bodies touch. */
VC_API int vc_evaluate_rates(const vc_model* model, vc_workspace* workspace,
                             const vc_motion* motion, const double* state, double* next_state,
                             double* rates, int state_size, vc_result* result);

/* The tangent of the last vc_evaluate or vc_evaluate_rates of this model in this workspace. */
VC_API int vc_tangent_of(const vc_model* model, vc_workspace* workspace, vc_tangent* tangent);

/* Writes up to `capacity` sites of the workspace's last evaluation and returns how many there are.
 */
VC_API int vc_sites(const vc_workspace* workspace, vc_site* sites, int capacity);

/* The overlap of two solids alone. `engine` as in vc_model_choose (null: auto); the tolerance is
 * the relative error asked of V. */
VC_API int vc_interference(const vc_solid* a, const vc_solid* b, const double* X_AB,
                           double tolerance, const char* engine, vc_workspace* workspace,
                           vc_metrics* metrics);

#ifdef __cplusplus
}
#endif

#endif /* VOLCONTACT_C_API_VOLCONTACT_H_ */

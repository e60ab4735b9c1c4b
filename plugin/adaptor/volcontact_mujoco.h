// SPDX-License-Identifier: Apache-2.0
#ifndef VOLCONTACT_ADAPTOR_VOLCONTACT_MUJOCO_H_
#define VOLCONTACT_ADAPTOR_VOLCONTACT_MUJOCO_H_

#include <mujoco/mujoco.h>

// Plain C interface of the adaptor: volumetric contact for the scenes of one MuJoCo release.
// docs/plugin.md. Units are SI, vectors are in the world frame.
//
// Functions that can fail return a negative VOLCONTACT_ERROR_... and write a text into `message`
// (at most `message_size` characters with the final zero; both may be 0).

#if defined(_WIN32)
#define VOLCONTACT_API __declspec(dllexport)
#else
#define VOLCONTACT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum {
  VOLCONTACT_ERROR_SCENE = -1,    // the scene cannot be used: the message says what to change
  VOLCONTACT_ERROR_VERSION = -2,  // built for another MuJoCo
  VOLCONTACT_ERROR_STATE = -3,    // attached already, or not attached
  VOLCONTACT_ERROR_INTERNAL = -4,
  VOLCONTACT_ERROR_MEMORY = -5  // out of memory; nothing was changed
};

// One contact site: a connected region in which two geoms overlap.
typedef struct volcontact_site_ {
  long long pair;  // number of the pair, as in the description: geom_a * ngeom + geom_b
  int geom_a;
  int geom_b;
  int status;             // 0 ok; others as in volcontact/metrics/volume_metrics.h
  double volume;          // of the interference [m^3]
  double centroid[3];     // of the volume [m]
  double normal[3];       // on a, from b to a
  double area;            // of the patch projected along the normal [m^2]
  double depth;           // longest column along the normal [m]
  double force[3];        // total force on a [N]
  double torque[3];       // on a, about the centroid [N m]
  double normal_force;    // [N]
  double slip;            // speed of a against b along the patch [m/s]
  double spin;            // of a against b about the normal [rad/s]
  double elastic_energy;  // [J]
  double flatness;        // 1 for a flat patch, small when the normal means little
  double volume_error;    // bound or estimate of the error of the volume [m^3]
} volcontact_site;

// One contact of a scene, a volumetric site or one of MuJoCo's own.
typedef struct volcontact_contact_ {
  int geom_a;  // -1: no geom, a flex
  int geom_b;
  int is_native;
  int reserved;
  double position[3];   // centroid of the overlap, or the contact point [m]
  double normal[3];     // on a, from b to a
  double force[3];      // on a [N]
  double torque[3];     // on a, about the position [N m]
  double normal_force;  // [N]
} volcontact_contact;

// How much of its arrays volcontact_site_surface filled.
typedef struct volcontact_surface_size_ {
  int columns;
  int triangles;
  int rim;
} volcontact_surface_size;

// Energies; channels in the order normal, roll, slide, spin.
typedef struct volcontact_energy_ {
  double elastic;        // stored in the contacts [J]
  double dissipated[4];  // since the start of the simulation [J]
  double power[4];       // dissipated now [W]
  double dropped;        // evaluations in which a force was no number and was left out
  double forgotten;      // evaluations with more contact sites than userdata keeps
  double work;           // done by the contact forces on the scene since the start [J]
  double numerical;      // driven - work - dissipated - change of elastic [J]
  double unpaid;         // what the laws hold besides `elastic`, which no motion put in [J]
  double driven;         // work of mocap bodies on the contacts since the start [J]
  double made;           // work + change of elastic - driven - released - lent, in a step [J]
  double released;       // of what was dissipated, to bodies that part slowly, since the start [J]
  double owed;           // lent by finite steps and not given back [J]
} volcontact_energy;

// mjVERSION_HEADER of the MuJoCo this library was compiled for.
VOLCONTACT_API int volcontact_mujoco_version(void);

// How long a struct of this file was when the library was compiled, such as "volcontact_site"
// [bytes]; 0 for other names. A program in another language compares it with its own.
VOLCONTACT_API int volcontact_record_size(const char* name);

// 0 when the MuJoCo in this process is the one this library was compiled for.
VOLCONTACT_API int volcontact_check_version(char* message, int message_size);

// A key of the program: "volcontact/option/..." or a field of "volcontact/material/<name>/...",
// named and numbered as in a file. The functions ..._with take such keys beside those of the file,
// and before them. A material that no tuple of the file names is that of all geoms without one.
typedef struct volcontact_key_ {
  const char* name;
  const double* numbers;
  int count;
} volcontact_key;

// How many numbers of mjData.userdata the scene needs.
VOLCONTACT_API int volcontact_userdata_size(const mjModel* m, char* message, int message_size);
VOLCONTACT_API int volcontact_userdata_size_with(const mjModel* m, const volcontact_key* keys,
                                                 int count, char* message, int message_size);

// Adds that many to m->nuserdata. Call it on a new model, before any mjData is made of it.
VOLCONTACT_API int volcontact_reserve(mjModel* m, char* message, int message_size);
VOLCONTACT_API int volcontact_reserve_with(mjModel* m, const volcontact_key* keys, int count,
                                           char* message, int message_size);

// Makes the contact of the model volumetric: native contact off, passive callback installed (one
// that was there before keeps being called). Warnings, if any, come in `message`, one a line.
// Detach before the model is deleted. A model without any key needs no room in userdata:
// docs/plugin.md, "Models without room".
VOLCONTACT_API int volcontact_attach(mjModel* m, char* message, int message_size);
VOLCONTACT_API int volcontact_attach_with(mjModel* m, const volcontact_key* keys, int count,
                                          char* message, int message_size);

// Restores native contact, and the callback when this was the last attached model.
VOLCONTACT_API int volcontact_detach(mjModel* m, char* message, int message_size);

VOLCONTACT_API int volcontact_is_attached(const mjModel* m);

// 1 while MuJoCo's passive callback is volcontact's; somebody may have replaced it.
VOLCONTACT_API int volcontact_is_installed(void);

// 1: every model with a `volcontact/...` key is attached by itself at its first evaluation, as
// MuJoCo makes one when it compiles; for programs that know nothing of volcontact. The file needs
// room in userdata (`volcontact check` prints the line). 0: no more. A library of another MuJoCo
// returns VOLCONTACT_ERROR_VERSION.
VOLCONTACT_API int volcontact_set_auto(int on);

// The passive callback itself, for programs that set mjcb_passive themselves.
VOLCONTACT_API void volcontact_passive(const mjModel* m, mjData* d);

// Takes our part out of the force array of the target: what remains is the user's. For data that
// go on under native contact, or before reading qfrc_applied.
VOLCONTACT_API int volcontact_release(const mjModel* m, mjData* d);

// Contact sites at the state of the last evaluation. Writes up to `capacity` of them and returns
// how many there are; 0 before the first evaluation.
VOLCONTACT_API int volcontact_sites(const mjModel* m, const mjData* d, volcontact_site* sites,
                                    int capacity);

// All contacts at the state of the last evaluation: volumetric sites, then those MuJoCo solved.
// Writes up to `capacity` of them and returns how many there are.
VOLCONTACT_API int volcontact_contacts(const mjModel* m, const mjData* d,
                                       volcontact_contact* contacts, int capacity);

// The shape of one site of volcontact_sites, for pictures, in world frame: columns along the
// contact normal (3 numbers of the low end and 3 of the high one, along the normal) [m], triangles
// of columns, counterclockwise seen against the normal, and lines of two columns around them, the
// overlap to the left. `resolution`, from 2 to 256: columns across, n below. Room is needed for
// 3 (n + 1)^2 columns, 4 n^2 triangles and 2 (n + 1)^2 lines. Returns 0, all sizes zero where the
// site is thinner than the columns are apart; VOLCONTACT_ERROR_SCENE where there is no such site.
VOLCONTACT_API int volcontact_site_surface(const mjModel* m, const mjData* d, int site,
                                           int resolution, double* columns, int* triangles,
                                           int* rim, volcontact_surface_size* size);

// Writes what the touch sensors measure to sensordata: MuJoCo sees its own contacts alone. Call it
// after mj_step or mj_forward, before sensordata is read.
VOLCONTACT_API int volcontact_update_touch(const mjModel* m, mjData* d);

// Energies at the last evaluation.
VOLCONTACT_API int volcontact_get_energy(const mjModel* m, const mjData* d,
                                         volcontact_energy* energy);

// A number of a running scene: what conditions, limits and peaks of a watched run speak of.
enum {
  VOLCONTACT_TIME = 0,  // [s]
  VOLCONTACT_QPOS = 1,  // element `index` of mjData.qpos; and so on
  VOLCONTACT_QVEL = 2,
  VOLCONTACT_ACT = 3,
  VOLCONTACT_CTRL = 4,
  VOLCONTACT_SENSOR = 5,
  VOLCONTACT_POSITION = 6,    // element `index` of mjData.xpos: 3 * body + axis [m]
  VOLCONTACT_DISTANCE = 7,    // of body `index` from the point `place` [m]
  VOLCONTACT_ANGLE = 8,       // of body `index` from the orientation `place`, a quaternion [degree]
  VOLCONTACT_SPEED = 9,       // of the frame of body `index` [m/s]
  VOLCONTACT_SPIN = 10,       // of body `index` [rad/s]
  VOLCONTACT_SITES = 11,      // of contact, in the last step
  VOLCONTACT_SITE_FORCE = 12  // the largest at one site in the last step [N]
};
typedef struct volcontact_number_ {
  int kind;
  int index;
  double place[4];
} volcontact_number;

// A number from `low` to `high`, both included.
typedef struct volcontact_range_ {
  volcontact_number number;
  double low;
  double high;
} volcontact_range;

// How a watched run ended.
enum {
  VOLCONTACT_GOES_ON = 0,
  VOLCONTACT_SUCCESS = 1,
  VOLCONTACT_JAMMED = 2,
  VOLCONTACT_FORCE_LIMIT = 3,
  VOLCONTACT_TORQUE_LIMIT = 4,
  VOLCONTACT_DIVERGED = 5  // MuJoCo found a bad state; it may have reset it
};

// What ends a run of steps, and what was felt in it. Set all of the first part, and of the second
// first_touch to NaN, good_since and jammed_since to infinity, peaks to -infinity, the rest to 0.
typedef struct volcontact_watch_ {
  const volcontact_range* success;  // all hold: good; none: that ends nothing
  const volcontact_range* jammed;   // all hold: jammed; none: never
  const volcontact_number* peak_numbers;
  const unsigned char* place_members;  // place_count rows of mjModel.ngeom: 1 for geoms of a place
  double* peaks;                       // largest of each of peak_numbers
  double* place_forces;                // sums of the forces at each place in the last step [N]
  double* place_peaks;                 // and their largest
  int success_count;
  int jammed_count;
  int peak_count;
  int place_count;
  int has_force;                     // watch the length of force_axes, not the sum of the sites
  int has_torque;                    // likewise
  volcontact_number force_axes[3];   // [N]
  volcontact_number torque_axes[3];  // [N m]
  double force_limit;
  double torque_limit;
  double hold;         // how long it must be good [s]
  double jam_time;     // and jammed [s]
  int judged_outside;  // being good ends nothing

  int outcome;
  int is_good;
  int geom_a;  // of the site with the largest force in the last step; -1: none, or a flex
  int geom_b;
  int reserved;
  double sites;       // in the last step
  double force;       // sum of the lengths of the forces of all sites, or as force_axes say [N]
  double torque;      // of the torques about each site's centroid [N m]
  double site_force;  // largest of a site [N]
  double peak_force;
  double peak_torque;
  double peak_site_force;
  double most_sites;
  double first_touch;  // time of the state in which the first site was seen [s]
  double good_since;
  double jammed_since;
} volcontact_watch;

// Steps a scene, attached or not, at most `steps` times, watching every step; returns how many it
// did. Contacts are those of the state that a step began with, ours and MuJoCo's own.
VOLCONTACT_API int volcontact_step_watched(const mjModel* m, mjData* d, int steps,
                                           volcontact_watch* watch);

// Reads numbers of a scene as it is now; what was felt of contact comes from `watch`, else is NaN.
VOLCONTACT_API int volcontact_read_numbers(const mjModel* m, const mjData* d,
                                           const volcontact_watch* watch,
                                           const volcontact_number* numbers, int count,
                                           double* values);

// What was understood of the scene, as JSON: options, materials, solids, pairs, warnings. The model
// need not be attached. Writes up to `capacity` characters with the final zero and returns the
// length of the whole text without it.
VOLCONTACT_API int volcontact_describe(const mjModel* m, char* text, int capacity, char* message,
                                       int message_size);

// The contact model of pair `pair` of the description as text, in the frames of its two geoms, as
// vc_model_create_text of the C container reads it. Writes and returns as volcontact_describe.
VOLCONTACT_API int volcontact_pair_text(const mjModel* m, long long pair, char* text, int capacity,
                                        char* message, int message_size);

// Why numbers that were changed in an attached model are not in force; empty when they are. Returns
// the length of the text.
VOLCONTACT_API int volcontact_live_error(const mjModel* m, char* message, int message_size);

#ifdef __cplusplus
}
#endif

#endif  // VOLCONTACT_ADAPTOR_VOLCONTACT_MUJOCO_H_

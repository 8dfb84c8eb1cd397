/* C interface of pkmopt: kinematics, dynamics and workspaces of parallel robots, and the optimisation of their design.
 *
 * Objects are opaque handles, arrays are contiguous and row by row (C order), lengths are in m, angles in rad and all
 * other numbers in SI units. Descriptions are JSON texts (UTF-8).
 *
 *   pkmopt_mechanism* delta;
 *   pkmopt_design* design;
 *   double pose[3] = {0.05, 0, -0.4}, joints[3];
 *   if (pkmopt_mechanism_from_file("rotary-delta.toml", NULL, &delta) ||
 *       pkmopt_design_create(delta, NULL, NULL, NULL, &design) ||
 *       pkmopt_design_inverse(design, 1, pose, joints, NULL))
 *     fprintf(stderr, "%s\n", pkmopt_error());
 *
 * Errors: functions that return pkmopt_status return PKMOPT_OK or an error; then pkmopt_error() is one sentence that
 * says what is wrong, and outputs are unspecified. No function throws or ends the process, except when memory of its
 * own is corrupted.
 *
 * Threads: different threads may use the same handle at the same time, except to free it, and except an optimiser
 * handle. There is no state of the process that two users could disturb: no signal handlers, no environment variables,
 * no output to the terminal. Results do not depend on the number of threads.
 *
 * Versions: PKMOPT_VERSION_MAJOR changes when a program must be changed or compiled again; while it is 0, the minor
 * version takes this role. */
#ifndef PKMOPT_H
#define PKMOPT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PKMOPT_API __attribute__((visibility("default")))

#define PKMOPT_VERSION_MAJOR 0
#define PKMOPT_VERSION_MINOR 1
#define PKMOPT_VERSION_PATCH 0

typedef enum pkmopt_status {
  PKMOPT_OK = 0,
  PKMOPT_INVALID_INPUT = 1, /* a name, a value or a text is invalid, or the mechanism does not support the request */
  PKMOPT_FILE_ERROR = 2,    /* a study file cannot be read or written */
  PKMOPT_DESIGN_ERROR = 3,  /* the design cannot be evaluated: its parameters do not describe a mechanism */
  PKMOPT_STOPPED = 4,       /* pkmopt_options.interrupt has asked to stop */
  PKMOPT_NO_MEMORY = 5,
  PKMOPT_INTERNAL_ERROR = 6 /* a bug of pkmopt */
} pkmopt_status;

/* Version of the library as text: "0.1.0". */
PKMOPT_API const char* pkmopt_version(void);
/* The last error of the calling thread: one sentence, valid until the next call on this thread; "" if none occurred. */
PKMOPT_API const char* pkmopt_error(void);
/* Frees a text or an array that a function has allocated. NULL is ignored. */
PKMOPT_API void pkmopt_free(void* memory);

/* The value of a text such as "200 mm" or "30 deg" in an SI unit such as "m" or "rad". */
PKMOPT_API pkmopt_status pkmopt_number(const char* text, const char* unit, double* value);

/* Options of functions that can take long. NULL stands for {0}. */
typedef struct pkmopt_options {
  /* Number of threads; 0: OMP_NUM_THREADS, else one per core. */
  int threads;
  /* If not NULL, called about every 50 ms on the calling thread; the function ends with PKMOPT_STOPPED soon after it
   * returns nonzero. */
  int (*interrupt)(void* user);
  void* user;
} pkmopt_options;

/* ---- Mechanisms ------------------------------------------------------------------------------------------------ */

typedef struct pkmopt_mechanism pkmopt_mechanism;

/* Names of the built-in mechanisms, a JSON array. */
PKMOPT_API pkmopt_status pkmopt_mechanism_names(char** json);
/* A built-in mechanism. */
PKMOPT_API pkmopt_status pkmopt_mechanism_by_name(const char* name, pkmopt_mechanism** mechanism);
/* A mechanism from its file. `limb_parameters` names, separated by commas, parameters that single limbs have of their
 * own, such as "arm2.l_b"; they are appended to the parameters of the file. NULL: none. */
PKMOPT_API pkmopt_status pkmopt_mechanism_from_file(const char* path, const char* limb_parameters,
                                                    pkmopt_mechanism** mechanism);
/* A mechanism from the text of a file. `file_name` is named in messages. */
PKMOPT_API pkmopt_status pkmopt_mechanism_from_text(const char* toml, const char* file_name,
                                                    const char* limb_parameters, pkmopt_mechanism** mechanism);
/* The mechanism with another mass model, one of `mass_models` of its description. */
PKMOPT_API pkmopt_status pkmopt_mechanism_with_masses(const pkmopt_mechanism* mechanism, const char* model,
                                                      pkmopt_mechanism** other);
/* Description: name, parameters, coordinates, joints, their units, modes, limits, quantities and what
 * `pkmopt list NAME --json` prints besides. */
PKMOPT_API pkmopt_status pkmopt_mechanism_info(const pkmopt_mechanism* mechanism, char** json);
/* The text of the mechanism file. */
PKMOPT_API pkmopt_status pkmopt_mechanism_text(const pkmopt_mechanism* mechanism, char** toml);
PKMOPT_API void pkmopt_mechanism_free(pkmopt_mechanism* mechanism);

/* ---- Designs: a mechanism with parameters, working mode and limits --------------------------------------------- */

typedef struct pkmopt_design pkmopt_design;

/* Creates a design.
 * parameters  all parameters in the order of the description; NULL: the default values
 * mode        working mode; NULL: the first one
 * limits      by limit in the order of the description: a threshold, or NaN for a limit that is not set; NULL: none */
PKMOPT_API pkmopt_status pkmopt_design_create(const pkmopt_mechanism* mechanism, const double* parameters,
                                              const char* mode, const double* limits, pkmopt_design** design);
PKMOPT_API void pkmopt_design_free(pkmopt_design* design);

/* Inverse kinematics at `count` poses.
 * poses   [count][coordinates]
 * joints  [count][joints]; a row of NaN: the pose does not assemble in this working mode */
PKMOPT_API pkmopt_status pkmopt_design_inverse(const pkmopt_design* design, size_t count, const double* poses,
                                               double* joints, const pkmopt_options* options);
/* The Jacobian J of the inverse kinematics: joint rates = J coordinate rates.
 * jacobians  [count][joints][coordinates]; NaN: the pose does not assemble; infinite or NaN: a serial singularity */
PKMOPT_API pkmopt_status pkmopt_design_jacobians(const pkmopt_design* design, size_t count, const double* poses,
                                                 double* jacobians, const pkmopt_options* options);
/* A quantity: one of `quantities` of the description that belongs to a pose, or "conditioning".
 * values  [count]; NaN: undefined */
PKMOPT_API pkmopt_status pkmopt_design_quantity(const pkmopt_design* design, const char* name, size_t count,
                                                const double* poses, double* values, const pkmopt_options* options);
/* Names of the constraints whose margins pkmopt_design_margins() computes, a JSON array. */
PKMOPT_API pkmopt_status pkmopt_design_margin_names(const pkmopt_design* design, char** json);
/* Margins of the constraints: joint ranges, limits, assembly. A pose is feasible if none is negative or NaN.
 * margins  [count][names] */
PKMOPT_API pkmopt_status pkmopt_design_margins(const pkmopt_design* design, size_t count, const double* poses,
                                               double* margins, const pkmopt_options* options);
/* Forward kinematics: the poses for given joint values.
 * joints    [count][joints]
 * near      [count][coordinates]: only the pose nearest to these, of those that a search from there finds; NULL: all
 *           poses that the mechanism's method finds, but those that are unusual in practice
 * capacity  number of poses stored for each row
 * poses     [count][capacity][coordinates]
 * found     [count]: number of poses found, which may exceed the capacity */
PKMOPT_API pkmopt_status pkmopt_design_forward(const pkmopt_design* design, size_t count, const double* joints,
                                               const double* near, size_t capacity, double* poses, size_t* found,
                                               const pkmopt_options* options);
/* Inverse dynamics and equations of motion at `count` states; each output may be NULL.
 * velocities, accelerations  [count][coordinates]; NULL: zero
 * wrenches                   [count][6]: forces and moments on the platform, Fx Fy Fz Mx My Mz; NULL: zero
 * forces                     [count][joints]: drive forces [N, N m]
 * inertia                    [count][joints][joints]: joint-space inertia matrix
 * coriolis, gravity          [count][joints]: its Coriolis and centrifugal forces, and gravity, at the joints
 * NaN: the pose does not assemble or is singular */
PKMOPT_API pkmopt_status pkmopt_design_dynamics(const pkmopt_design* design, size_t count, const double* poses,
                                                const double* velocities, const double* accelerations,
                                                const double* wrenches, double* forces, double* inertia,
                                                double* coriolis, double* gravity, const pkmopt_options* options);
/* Names and parts of the links, a JSON array of {"name": .., "part": ..}. */
PKMOPT_API pkmopt_status pkmopt_design_link_names(const pkmopt_design* design, char** json);
/* The links as capsules.
 * capsules  [count][links][7]: both ends of the axis and the radius; NaN: the pose does not assemble */
PKMOPT_API pkmopt_status pkmopt_design_links(const pkmopt_design* design, size_t count, const double* poses,
                                             double* capsules, const pkmopt_options* options);

/* ---- Studies: a design problem and its optimisers -------------------------------------------------------------- */

typedef struct pkmopt_study pkmopt_study;

/* A study from its TOML file. `changes`: lines "set NAME=VALUE", "limit NAME=VALUE" or "cells NAME=NUMBER" as the
 * options --set, --limit and --cells; NULL: none. */
PKMOPT_API pkmopt_status pkmopt_study_from_file(const char* path, const char* changes, pkmopt_study** study);
/* A study from text. If its [mechanism] names a file, `mechanism_toml` is the text of that file, else NULL.
 * `file_name` and `mechanism_file_name` are named in messages and stored with the study. */
PKMOPT_API pkmopt_status pkmopt_study_from_text(const char* toml, const char* file_name, const char* mechanism_toml,
                                                const char* mechanism_file_name, const char* changes,
                                                pkmopt_study** study);
/* Description: name, seed, parameters, variables, objectives, constraints, outputs, functions, stages, swept
 * coordinates, text, warnings. */
PKMOPT_API pkmopt_status pkmopt_study_info(const pkmopt_study* study, char** json);
PKMOPT_API void pkmopt_study_free(pkmopt_study* study);

/* Functions that a study calls: objectives, constraints and outputs with type = "python". Their names are `functions`
 * of its description. */
typedef struct pkmopt_functions {
  /* Calls one of them for one design. Thread-safe unless the study is evaluated on one thread and has no solver stages.
   * parameters  all parameters of the mechanism
   * reason      why the call failed: a text of at most `capacity` bytes, its NUL included
   * Returns 0; nonzero if the call failed, so that the design fails. */
  int (*function)(const char* call, const double* parameters, double* value, char* reason, size_t capacity, void* user);
  void* user;
  /* The functions and hashes of what defines them, see pkmopt_hash(); a study file is continued with equal hashes only.
   * "": unknown. */
  size_t count;
  const char* const* calls;
  const char* const* hashes;
} pkmopt_functions;
/* How processes that call Python functions are started. Zeros and NULL: one process per thread, "python3", no folders.
 */
typedef struct pkmopt_python {
  int workers;
  const char* program;
  const char* path; /* further folders of modules, separated by ':' */
} pkmopt_python;

/* Has the functions of a study called by the caller, on the thread that evaluates or runs it, except for solver stages,
 * whose multistart runs call them from several threads. To be called before the study is evaluated. */
PKMOPT_API pkmopt_status pkmopt_study_set_functions(pkmopt_study* study, const pkmopt_functions* functions);
/* Has the functions of a study called by Python processes. To be called before the study is evaluated.
 * folder  where the files of the functions are; NULL: the current one */
PKMOPT_API pkmopt_status pkmopt_study_start_workers(pkmopt_study* study, const char* folder,
                                                    const pkmopt_python* python, const pkmopt_options* options);
/* The hash of a text, as study files hold it. */
PKMOPT_API pkmopt_status pkmopt_hash(const char* bytes, size_t size, char** hash);

/* Status of an evaluated design. */
enum {
  PKMOPT_FEASIBLE = 0,
  PKMOPT_INFEASIBLE = 1, /* a constraint is violated */
  PKMOPT_REJECTED = 2,   /* a constraint of the design alone is violated; values that need a workspace may be NaN */
  PKMOPT_FAILED = 3      /* the design cannot be evaluated, or a value is not finite */
};
/* Evaluates designs on all threads. Each output may be NULL.
 * designs     [count][variables]: may be outside of the bounds of the variables; outside of what the mechanism allows,
 *             designs have failed
 * objectives  [count][objectives]: values, whether minimised or maximised
 * margins     [count][constraints]: satisfied if >= 0
 * outputs     [count][outputs]
 * status      [count]
 * complete    0: the evaluation of a design may end at a violated constraint of the design alone, as optimisers do */
PKMOPT_API pkmopt_status pkmopt_study_evaluate(const pkmopt_study* study, size_t count, const double* designs,
                                               int complete, double* objectives, double* margins, double* outputs,
                                               uint8_t* status, const pkmopt_options* options);
/* Evaluates designs with exact derivatives; each output may be NULL. Non-smooth values have those of a smooth
 * approximation. derivatives  [count][objectives + constraints][1 + variables]: the smooth value, then its derivatives
 */
PKMOPT_API pkmopt_status pkmopt_study_differentiate(const pkmopt_study* study, size_t count, const double* designs,
                                                    double* objectives, double* margins, double* outputs,
                                                    uint8_t* status, double* derivatives,
                                                    const pkmopt_options* options);
/* Why the design failed, one sentence; "" if it did not fail. */
PKMOPT_API pkmopt_status pkmopt_study_why_failed(const pkmopt_study* study, const double* design, char** sentence,
                                                 const pkmopt_options* options);
/* The workspace volume of a design given by all parameters, with its derivatives.
 * parameters  [parameters]
 * volume      in the unit `volume_unit` of the description
 * error       relative error estimate, as far as sampled where parts between sampled slices can be missed; NaN for
 *             voxels
 * gradient    [parameters]; NULL: none is computed */
PKMOPT_API pkmopt_status pkmopt_study_volume(const pkmopt_study* study, const double* parameters, double* volume,
                                             double* error, double* gradient, const pkmopt_options* options);
/* Fields on a voxel grid over the workspace of a design.
 * parameters  [parameters]
 * json        axes (name, unit, lower, upper, cells), fixed coordinates, fields (name, unit, meaning), volume
 * values      [fields][cells ..]: allocated; NaN where a field is undefined */
PKMOPT_API pkmopt_status pkmopt_study_fields(const pkmopt_study* study, const double* parameters, const char* mode,
                                             char** json, double** values, const pkmopt_options* options);
/* The boundary surface of a workspace over three coordinates.
 * vertices   [vertex_count][3], triangles [triangle_count][3]: allocated */
PKMOPT_API pkmopt_status pkmopt_study_surface(const pkmopt_study* study, const double* parameters, size_t* vertex_count,
                                              double** vertices, size_t* triangle_count, uint32_t** triangles,
                                              const pkmopt_options* options);

/* Progress of a run, after each generation. */
typedef struct pkmopt_progress {
  int stage, stages;                                 /* the current stage, from 1; the number of stages */
  int64_t generation, evaluations, evaluation_limit; /* of the stage; evaluation_limit 0: none */
  double seconds;                                    /* wall time of this run */
  double best;           /* the first objective of the best feasible design; NaN: no design is feasible */
  double violation;      /* while no design is feasible: the smallest sum of violations */
  size_t front;          /* several objectives: number of points of the Pareto front */
  double hypervolume;    /* several objectives; NaN: unknown */
  double feasible_share; /* of the population */
} pkmopt_progress;

typedef struct pkmopt_run_options {
  pkmopt_options common;
  double time_limit; /* wall time [s] after which the run stops with a checkpoint; <= 0: none */
  int overwrite;     /* nonzero: an existing file is replaced */
  /* Called on the calling thread after each generation, except while recorded ones are replayed; nonzero: stop with a
   * checkpoint. NULL: none. */
  int (*progress)(const pkmopt_progress* progress, void* user);
  void* user;
  /* For a resumed study that calls functions: how they are called. NULL: by Python processes. */
  const pkmopt_functions* functions;
  const pkmopt_python* python; /* NULL stands for {0} */
} pkmopt_run_options;

/* Runs a study and writes its file, with the same bits as `pkmopt run`.
 * path  of the study file (HDF5)
 * seed  >= 0; negative: that of the study
 * json  summary of the outcome: stopped, seconds, evaluations, warnings; allocated */
PKMOPT_API pkmopt_status pkmopt_study_run(const pkmopt_study* study, const char* path, int64_t seed,
                                          const pkmopt_run_options* options, char** json);
/* Continues a stopped study from its file, or extends the last stage of a finished one to these totals; <= 0: as
 * recorded. */
PKMOPT_API pkmopt_status pkmopt_study_resume(const char* path, int64_t generations, int64_t evaluations,
                                             const pkmopt_run_options* options, char** json);

/* ---- Results: the contents of a study file --------------------------------------------------------------------- */

typedef struct pkmopt_results pkmopt_results;

/* Reads and verifies a study file. */
PKMOPT_API pkmopt_status pkmopt_results_open(const char* path, pkmopt_results** results);
PKMOPT_API void pkmopt_results_free(pkmopt_results* results);
/* Summary as `pkmopt show F.h5 --json`, with the number of rows of each stage. */
PKMOPT_API pkmopt_status pkmopt_results_info(const pkmopt_results* results, char** json);
/* The evaluations of a stage, in their order; each array may be NULL.
 * stage       from 0
 * designs     [rows][variables], objectives [rows][objectives], margins [rows][constraints], outputs [rows][outputs]
 * status      [rows], generation [rows]: the generation that evaluated the row, seconds [rows]: time of evaluation */
PKMOPT_API pkmopt_status pkmopt_results_evaluations(const pkmopt_results* results, size_t stage, double* designs,
                                                    double* objectives, double* margins, double* outputs,
                                                    uint8_t* status, int64_t* generation, double* seconds);
/* Rows of the population of a generation, or of the Pareto front if `generation` is negative.
 * rows   allocated, or NULL to count only */
PKMOPT_API pkmopt_status pkmopt_results_population(const pkmopt_results* results, size_t stage, int64_t generation,
                                                   size_t* count, int64_t** rows);
/* The study that the file contains. */
PKMOPT_API pkmopt_status pkmopt_results_study(const pkmopt_results* results, pkmopt_study** study);
/* Writes the report of study files, an HTML page. */
PKMOPT_API pkmopt_status pkmopt_report(size_t count, const char* const* paths, const char* output, int overwrite,
                                       const pkmopt_options* options);

/* ---- Optimisers for functions of your own ---------------------------------------------------------------------- */

typedef struct pkmopt_optimiser pkmopt_optimiser;

/* Names of the optimisers, a JSON array. */
PKMOPT_API pkmopt_status pkmopt_optimiser_names(char** json);

/* Creates an optimiser, which asks for designs to evaluate and is told their values.
 * options     the lines of a [[stage]] in TOML: "optimiser = 'ga'\npopulation = 40\ngenerations = 50"; variables are
 *             named x1, x2, .., objectives f1, f2, ..
 * lower, upper, step  [variables]; step NULL or 0: continuous
 * maximise    [objectives]: nonzero for an objective that is maximised; NULL: all are minimised
 * margins     number of constraints
 * The same arguments and values give the same designs: those that `pkmopt run` evaluates for the same function. */
PKMOPT_API pkmopt_status pkmopt_optimiser_create(const char* options, size_t variables, const double* lower,
                                                 const double* upper, const double* step, size_t objectives,
                                                 const int* maximise, size_t margins, uint64_t seed,
                                                 pkmopt_optimiser** optimiser);
PKMOPT_API void pkmopt_optimiser_free(pkmopt_optimiser* optimiser);
/* The designs to evaluate next, all at once. The same ones until tell() is called.
 * count        0: the optimiser has finished
 * designs      [count][variables]: valid until the next tell()
 * derivatives  nonzero: the optimiser needs derivatives */
PKMOPT_API pkmopt_status pkmopt_optimiser_ask(pkmopt_optimiser* optimiser, size_t* count, const double** designs,
                                              int* derivatives);
/* The values of the designs of the last ask().
 * objectives   [count][objectives]; NaN: the design failed
 * margins      [count][constraints]: satisfied if >= 0; NULL if there are none
 * derivatives  [count][objectives + constraints][variables]; NULL unless the optimiser needs them
 * status       [count]: PKMOPT_FEASIBLE, ..; NULL: from the values */
PKMOPT_API pkmopt_status pkmopt_optimiser_tell(pkmopt_optimiser* optimiser, const double* objectives,
                                               const double* margins, const double* derivatives, const uint8_t* status);
/* All evaluations so far; each array may be NULL.
 * rows  their number; best: row of the best one, -1: none */
PKMOPT_API pkmopt_status pkmopt_optimiser_evaluations(const pkmopt_optimiser* optimiser, size_t* rows, double* designs,
                                                      double* objectives, double* margins, uint8_t* status,
                                                      int64_t* best);

#ifdef __cplusplus
}
#endif

#endif

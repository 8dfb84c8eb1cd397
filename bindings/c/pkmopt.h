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
 * Errors: functions that return pkmopt_status return PKMOPT_OK or an error. After an error, pkmopt_error() returns one
 * sentence that describes it, and outputs are unspecified. No function throws an exception or ends the process, unless
 * its memory is corrupted.
 *
 * Threads: different threads may use the same handle at the same time, except to free it, and except an optimiser
 * handle. The library changes no state of the process: no signal handlers, no environment variables, and it writes
 * nothing to the terminal. Results do not depend on the number of threads.
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
#define PKMOPT_VERSION_MINOR 2
#define PKMOPT_VERSION_PATCH 0

typedef enum pkmopt_status {
  PKMOPT_OK = 0,
  PKMOPT_INVALID_INPUT = 1, /* a name, a value or a text is invalid, or the mechanism does not support the request */
  PKMOPT_FILE_ERROR = 2,    /* a study file cannot be read or written */
  PKMOPT_DESIGN_ERROR = 3,  /* the design cannot be evaluated: its parameters do not describe a mechanism */
  PKMOPT_STOPPED = 4,       /* pkmopt_options.interrupt has requested a stop */
  PKMOPT_NO_MEMORY = 5,     /* memory could not be allocated */
  PKMOPT_INTERNAL_ERROR = 6 /* a bug of pkmopt */
} pkmopt_status;

/* Version of the library as text: "0.2.0". */
PKMOPT_API const char* pkmopt_version(void);
/* Returns the last error of the calling thread as one sentence; "" if no error occurred. The text is valid until the
 * next call on this thread. */
PKMOPT_API const char* pkmopt_error(void);
/* Frees a text or an array that a function has allocated. NULL is ignored. */
PKMOPT_API void pkmopt_free(void* memory);

/* Converts a text such as "200 mm" or "30 deg" to a number in an SI unit such as "m" or "rad". */
PKMOPT_API pkmopt_status pkmopt_number(const char* text, const char* unit, double* value);

/* Options of functions that can take long. NULL stands for {0}. */
typedef struct pkmopt_options {
  /* Number of threads; 0: the value of OMP_NUM_THREADS or, if it is not set, one thread per core. */
  int threads;
  /* If not NULL, called about every 50 ms on the calling thread; the function ends with PKMOPT_STOPPED soon after it
   * returns nonzero. */
  int (*interrupt)(void* user);
  void* user;
} pkmopt_options;

/* ---- Mechanisms ------------------------------------------------------------------------------------------------ */

typedef struct pkmopt_mechanism pkmopt_mechanism;

/* Returns the names of the built-in mechanisms as a JSON array. */
PKMOPT_API pkmopt_status pkmopt_mechanism_names(char** json);
/* Creates a built-in mechanism. */
PKMOPT_API pkmopt_status pkmopt_mechanism_by_name(const char* name, pkmopt_mechanism** mechanism);
/* Creates a mechanism from its file. `limb_parameters`: names, separated by commas, of additional parameters that
 * belong to a single limb, such as "arm2.l_b"; they are appended to the parameters of the file. NULL: none. */
PKMOPT_API pkmopt_status pkmopt_mechanism_from_file(const char* path, const char* limb_parameters,
                                                    pkmopt_mechanism** mechanism);
/* Creates a mechanism from the text of a mechanism file. Messages mention `file_name`. */
PKMOPT_API pkmopt_status pkmopt_mechanism_from_text(const char* toml, const char* file_name,
                                                    const char* limb_parameters, pkmopt_mechanism** mechanism);
/* Creates a copy of a mechanism with another mass model: one of `mass_models` in its description. */
PKMOPT_API pkmopt_status pkmopt_mechanism_with_masses(const pkmopt_mechanism* mechanism, const char* model,
                                                      pkmopt_mechanism** other);
/* Returns the description of a mechanism: name, parameters, coordinates, joints, their units, modes, limits,
 * quantities, and everything else that `pkmopt list NAME --json` prints. */
PKMOPT_API pkmopt_status pkmopt_mechanism_info(const pkmopt_mechanism* mechanism, char** json);
/* Returns the text of the mechanism file. */
PKMOPT_API pkmopt_status pkmopt_mechanism_text(const pkmopt_mechanism* mechanism, char** toml);
PKMOPT_API void pkmopt_mechanism_free(pkmopt_mechanism* mechanism);

/* ---- Designs: a mechanism with parameters, working mode and limits --------------------------------------------- */

typedef struct pkmopt_design pkmopt_design;

/* Creates a design.
 * parameters  all parameters in the order of the description; NULL: the default values
 * mode        working mode; NULL: the first one
 * limits      for each limit, in the order of the description, its threshold, or NaN for no limit; NULL: no limits */
PKMOPT_API pkmopt_status pkmopt_design_create(const pkmopt_mechanism* mechanism, const double* parameters,
                                              const char* mode, const double* limits, pkmopt_design** design);
PKMOPT_API void pkmopt_design_free(pkmopt_design* design);

/* Inverse kinematics at `count` poses.
 * poses   [count][coordinates]
 * joints  [count][joints]; a row of NaN: the mechanism cannot be assembled at the pose in this working mode */
PKMOPT_API pkmopt_status pkmopt_design_inverse(const pkmopt_design* design, size_t count, const double* poses,
                                               double* joints, const pkmopt_options* options);
/* The Jacobian J of the inverse kinematics at `count` poses: joint rates = J coordinate rates.
 * jacobians  [count][joints][coordinates]; NaN: the mechanism cannot be assembled at the pose; infinite or NaN: the
 *            pose is a serial singularity */
PKMOPT_API pkmopt_status pkmopt_design_jacobians(const pkmopt_design* design, size_t count, const double* poses,
                                                 double* jacobians, const pkmopt_options* options);
/* A quantity at `count` poses: one of `quantities` of the description that depend on the pose, or "conditioning".
 * values  [count]; NaN: the quantity is undefined */
PKMOPT_API pkmopt_status pkmopt_design_quantity(const pkmopt_design* design, const char* name, size_t count,
                                                const double* poses, double* values, const pkmopt_options* options);
/* Returns the names of the constraints whose margins pkmopt_design_margins() computes, as a JSON array. */
PKMOPT_API pkmopt_status pkmopt_design_margin_names(const pkmopt_design* design, char** json);
/* Margins of the constraints (joint ranges, limits, assembly) at `count` poses. A pose is feasible if none of its
 * margins is negative or NaN.
 * margins  [count][names] */
PKMOPT_API pkmopt_status pkmopt_design_margins(const pkmopt_design* design, size_t count, const double* poses,
                                               double* margins, const pkmopt_options* options);
/* Forward kinematics: the poses for given joint values.
 * joints    [count][joints]
 * near      [count][coordinates]: for each row, a search starts from this pose, and of the poses that it finds only the
 *           nearest one is returned; NULL: all poses that the method of the mechanism finds are returned, except those
 *           that are unusual in practice
 * capacity  maximum number of poses that are stored for each row
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
 * coriolis                   [count][joints]: Coriolis and centrifugal forces at the joints
 * gravity                    [count][joints]: gravity forces at the joints
 * NaN: the mechanism cannot be assembled at the pose, or the pose is singular */
PKMOPT_API pkmopt_status pkmopt_design_dynamics(const pkmopt_design* design, size_t count, const double* poses,
                                                const double* velocities, const double* accelerations,
                                                const double* wrenches, double* forces, double* inertia,
                                                double* coriolis, double* gravity, const pkmopt_options* options);
/* Returns the names and parts of the links as a JSON array of {"name": .., "part": ..}. */
PKMOPT_API pkmopt_status pkmopt_design_link_names(const pkmopt_design* design, char** json);
/* The links as capsules at `count` poses.
 * capsules  [count][links][7]: both ends of the axis and the radius; NaN: the mechanism cannot be assembled at the
 *           pose */
PKMOPT_API pkmopt_status pkmopt_design_links(const pkmopt_design* design, size_t count, const double* poses,
                                             double* capsules, const pkmopt_options* options);

/* ---- Studies: a design problem and its optimisers -------------------------------------------------------------- */

typedef struct pkmopt_study pkmopt_study;

/* Creates a study from its TOML file. `changes`: lines "set NAME=VALUE", "limit NAME=VALUE" or "cells NAME=NUMBER",
 * with the same effect as the options --set, --limit and --cells of `pkmopt run`; NULL: none. */
PKMOPT_API pkmopt_status pkmopt_study_from_file(const char* path, const char* changes, pkmopt_study** study);
/* Creates a study from text. If its table [mechanism] names a file, `mechanism_toml` is the text of that file,
 * otherwise NULL. Messages mention `file_name` and `mechanism_file_name`, and both are stored with the study. */
PKMOPT_API pkmopt_status pkmopt_study_from_text(const char* toml, const char* file_name, const char* mechanism_toml,
                                                const char* mechanism_file_name, const char* changes,
                                                pkmopt_study** study);
/* Returns the description of a study: name, seed, parameters, variables, objectives, constraints, outputs, functions,
 * stages, swept coordinates, text, warnings. */
PKMOPT_API pkmopt_status pkmopt_study_info(const pkmopt_study* study, char** json);
PKMOPT_API void pkmopt_study_free(pkmopt_study* study);

/* Functions that a study calls: objectives, constraints and outputs with type = "python". Their names are `functions`
 * of its description. */
typedef struct pkmopt_functions {
  /* Calls the function with the name `call` for one design. It has to be thread-safe unless the study is evaluated on
   * one thread and has no solver stages.
   * parameters  values of all parameters of the mechanism
   * value       receives the value of the function
   * reason      receives the reason if the call fails: a text of at most `capacity` bytes, its NUL included
   * Returns 0, or a nonzero number if the call failed; the design then has the status PKMOPT_FAILED. */
  int (*function)(const char* call, const double* parameters, double* value, char* reason, size_t capacity, void* user);
  void* user;
  /* Names of the functions, and hashes of the texts that define them, see pkmopt_hash(); "": the hash is unknown. A
   * study file can be resumed only with functions that have the same hashes. */
  size_t count;
  const char* const* calls;
  const char* const* hashes;
} pkmopt_functions;
/* How worker processes that call Python functions are started. */
typedef struct pkmopt_python {
  int workers;         /* number of processes; 0: one per thread */
  const char* program; /* command that starts the Python interpreter; NULL: "python3" */
  const char* path;    /* additional folders of Python modules, separated by ':'; NULL: none */
} pkmopt_python;

/* Sets the functions of the calling program that a study calls. They are called on the thread that evaluates or runs
 * the study, except in solver stages, whose multistart runs call them on several threads. Must be called before the
 * study is evaluated. */
PKMOPT_API pkmopt_status pkmopt_study_set_functions(pkmopt_study* study, const pkmopt_functions* functions);
/* Starts worker processes that call the Python functions of a study. Must be called before the study is evaluated.
 * folder  folder that contains the files of the functions; NULL: the current folder */
PKMOPT_API pkmopt_status pkmopt_study_start_workers(pkmopt_study* study, const char* folder,
                                                    const pkmopt_python* python, const pkmopt_options* options);
/* Returns the hash of a text in the form in which study files store it. */
PKMOPT_API pkmopt_status pkmopt_hash(const char* bytes, size_t size, char** hash);

/* Status of an evaluated design. */
enum {
  PKMOPT_FEASIBLE = 0,
  PKMOPT_INFEASIBLE = 1, /* a constraint is violated */
  PKMOPT_REJECTED = 2,   /* a constraint of the design alone is violated; values that need a workspace may be NaN */
  PKMOPT_FAILED = 3      /* the design cannot be evaluated, or a value is not finite */
};
/* Evaluates designs on all threads. Each output may be NULL.
 * designs     [count][variables]: may be outside of the bounds of the variables; a design that the mechanism does not
 *             allow gets the status PKMOPT_FAILED
 * objectives  [count][objectives]: values; maximised objectives do not change their sign
 * margins     [count][constraints]: satisfied if >= 0
 * outputs     [count][outputs]
 * status      [count]
 * complete    0: the evaluation of a design may end at a violated constraint of the design alone, as optimisers do */
PKMOPT_API pkmopt_status pkmopt_study_evaluate(const pkmopt_study* study, size_t count, const double* designs,
                                               int complete, double* objectives, double* margins, double* outputs,
                                               uint8_t* status, const pkmopt_options* options);
/* Evaluates designs with exact derivatives; each output may be NULL. The derivatives of a non-smooth value are those of
 * its smooth approximation.
 * derivatives  [count][objectives + constraints][1 + variables]: value of the smooth approximation, then its
 *              derivatives
 */
PKMOPT_API pkmopt_status pkmopt_study_differentiate(const pkmopt_study* study, size_t count, const double* designs,
                                                    double* objectives, double* margins, double* outputs,
                                                    uint8_t* status, double* derivatives,
                                                    const pkmopt_options* options);
/* Returns one sentence that states why the design failed; "" if it did not fail. */
PKMOPT_API pkmopt_status pkmopt_study_why_failed(const pkmopt_study* study, const double* design, char** sentence,
                                                 const pkmopt_options* options);
/* The workspace volume of a design given by all parameters, with its derivatives.
 * parameters  [parameters]
 * volume      in the unit `volume_unit` of the description
 * error       estimate of the relative error; it does not include components of the workspace that lie between sampled
 *             slices; NaN for voxels
 * gradient    [parameters]: derivatives of the volume; NULL: they are not computed */
PKMOPT_API pkmopt_status pkmopt_study_volume(const pkmopt_study* study, const double* parameters, double* volume,
                                             double* error, double* gradient, const pkmopt_options* options);
/* Fields on a voxel grid over the workspace of a design.
 * parameters  [parameters]
 * json        axes (name, unit, lower, upper, cells), fixed coordinates, fields (name, unit, meaning), volume
 * values      [fields][cells ..]: allocated by the function; NaN where a field is undefined */
PKMOPT_API pkmopt_status pkmopt_study_fields(const pkmopt_study* study, const double* parameters, const char* mode,
                                             char** json, double** values, const pkmopt_options* options);
/* The boundary surface of a workspace over three coordinates.
 * vertices   [vertex_count][3]: coordinates of the vertices; allocated by the function
 * triangles  [triangle_count][3]: indices of three vertices; allocated by the function */
PKMOPT_API pkmopt_status pkmopt_study_surface(const pkmopt_study* study, const double* parameters, size_t* vertex_count,
                                              double** vertices, size_t* triangle_count, uint32_t** triangles,
                                              const pkmopt_options* options);

/* Progress of a run, after each generation. */
typedef struct pkmopt_progress {
  int stage, stages;                                 /* the current stage, from 1; the number of stages */
  int64_t generation, evaluations, evaluation_limit; /* of the current stage; evaluation_limit 0: no limit */
  double seconds;                                    /* wall time of this run */
  double best;           /* the first objective of the best feasible design; NaN: no design is feasible */
  double violation;      /* while no design is feasible: the smallest sum of violations */
  size_t front;          /* several objectives: number of points of the Pareto front */
  double hypervolume;    /* several objectives: hypervolume of the front; NaN: not computed */
  double feasible_share; /* share of the population that is feasible, in [0, 1] */
} pkmopt_progress;

typedef struct pkmopt_run_options {
  pkmopt_options common;
  double time_limit; /* wall time [s] after which the run stops with a checkpoint; <= 0: no limit */
  int overwrite;     /* nonzero: an existing file is replaced */
  /* Called on the calling thread after each generation, except while recorded generations are replayed. A nonzero
   * return value stops the run with a checkpoint. NULL: no function is called. */
  int (*progress)(const pkmopt_progress* progress, void* user);
  void* user;
  /* Functions that a resumed study calls. NULL: Python worker processes call them. */
  const pkmopt_functions* functions;
  const pkmopt_python* python; /* NULL stands for {0} */
} pkmopt_run_options;

/* Runs a study and writes its file; the results are bitwise equal to those of `pkmopt run`.
 * path  name of the study file (HDF5) to be written
 * seed  seed of the run, >= 0; negative: the seed of the study
 * json  summary of the outcome: stopped, seconds, evaluations, warnings; allocated by the function */
PKMOPT_API pkmopt_status pkmopt_study_run(const pkmopt_study* study, const char* path, int64_t seed,
                                          const pkmopt_run_options* options, char** json);
/* Resumes a stopped study from its file, or extends the last stage of a finished study to these total numbers of
 * generations and evaluations; a number <= 0 keeps the recorded limit. */
PKMOPT_API pkmopt_status pkmopt_study_resume(const char* path, int64_t generations, int64_t evaluations,
                                             const pkmopt_run_options* options, char** json);

/* ---- Results: the contents of a study file --------------------------------------------------------------------- */

typedef struct pkmopt_results pkmopt_results;

/* Reads and verifies a study file. */
PKMOPT_API pkmopt_status pkmopt_results_open(const char* path, pkmopt_results** results);
PKMOPT_API void pkmopt_results_free(pkmopt_results* results);
/* Returns the summary that `pkmopt show F.h5 --json` prints, and the number of rows of each stage. */
PKMOPT_API pkmopt_status pkmopt_results_info(const pkmopt_results* results, char** json);
/* The evaluations of a stage, in their order; each array may be NULL.
 * stage       index of the stage, from 0
 * designs     [rows][variables], objectives [rows][objectives], margins [rows][constraints], outputs [rows][outputs]
 * status      [rows]: PKMOPT_FEASIBLE, ..
 * generation  [rows]: number of the generation that evaluated the row
 * seconds     [rows]: time of the evaluation [s] */
PKMOPT_API pkmopt_status pkmopt_results_evaluations(const pkmopt_results* results, size_t stage, double* designs,
                                                    double* objectives, double* margins, double* outputs,
                                                    uint8_t* status, int64_t* generation, double* seconds);
/* Returns the row numbers of the population of a generation or, if `generation` is negative, of the Pareto front.
 * rows   allocated by the function; NULL: only `count` is returned */
PKMOPT_API pkmopt_status pkmopt_results_population(const pkmopt_results* results, size_t stage, int64_t generation,
                                                   size_t* count, int64_t** rows);
/* Creates the study that a study file contains. */
PKMOPT_API pkmopt_status pkmopt_results_study(const pkmopt_results* results, pkmopt_study** study);
/* Writes the report of several study files as one HTML page. */
PKMOPT_API pkmopt_status pkmopt_report(size_t count, const char* const* paths, const char* output, int overwrite,
                                       const pkmopt_options* options);

/* ---- Optimisers for functions of your own ---------------------------------------------------------------------- */

typedef struct pkmopt_optimiser pkmopt_optimiser;

/* Returns the names of the optimisers as a JSON array. */
PKMOPT_API pkmopt_status pkmopt_optimiser_names(char** json);

/* Creates an optimiser with an ask-and-tell interface: the caller obtains designs by ask(), evaluates them, and returns
 * their values by tell().
 * options     the lines of a [[stage]] in TOML: "optimiser = 'ga'\npopulation = 40\ngenerations = 50"; variables are
 *             named x1, x2, .., objectives f1, f2, ..
 * lower, upper, step  [variables]: bounds and step of each variable; step NULL or 0: the variable is continuous
 * maximise    [objectives]: nonzero for an objective that is maximised; NULL: all are minimised
 * margins     number of constraints
 * The same arguments and values give the same designs: those that `pkmopt run` evaluates for the same function. */
PKMOPT_API pkmopt_status pkmopt_optimiser_create(const char* options, size_t variables, const double* lower,
                                                 const double* upper, const double* step, size_t objectives,
                                                 const int* maximise, size_t margins, uint64_t seed,
                                                 pkmopt_optimiser** optimiser);
PKMOPT_API void pkmopt_optimiser_free(pkmopt_optimiser* optimiser);
/* Returns all designs that have to be evaluated next. The designs are the same until tell() is called.
 * count        number of designs; 0: the optimiser has finished
 * designs      [count][variables]: valid until the next tell()
 * derivatives  nonzero: the optimiser needs derivatives */
PKMOPT_API pkmopt_status pkmopt_optimiser_ask(pkmopt_optimiser* optimiser, size_t* count, const double** designs,
                                              int* derivatives);
/* Passes the values of the designs that the last ask() returned to the optimiser.
 * objectives   [count][objectives]; NaN: the design failed
 * margins      [count][constraints]: satisfied if >= 0; NULL if there are none
 * derivatives  [count][objectives + constraints][variables]; NULL unless the optimiser needs them
 * status       [count]: PKMOPT_FEASIBLE, ..; NULL: the status follows from the values */
PKMOPT_API pkmopt_status pkmopt_optimiser_tell(pkmopt_optimiser* optimiser, const double* objectives,
                                               const double* margins, const double* derivatives, const uint8_t* status);
/* Returns all evaluations so far; each array may be NULL.
 * rows  number of evaluations
 * best  row number of the best evaluation; -1: there is none */
PKMOPT_API pkmopt_status pkmopt_optimiser_evaluations(const pkmopt_optimiser* optimiser, size_t* rows, double* designs,
                                                      double* objectives, double* margins, uint8_t* status,
                                                      int64_t* best);

#ifdef __cplusplus
}
#endif

#endif

/* The functions of pkmopt.h for loadlibrary() of MATLAB, made by make_header.py. Objects and options are void*, and
 * a status is an int: 0 is success; see pkmopt.h for everything else. Options have to be NULL. */
#include <stddef.h>
#include <stdint.h>

const char* pkmopt_version(void);
const char* pkmopt_error(void);
void pkmopt_free(void* memory);
int pkmopt_number(const char* text, const char* unit, double* value);
int pkmopt_mechanism_names(char** json);
int pkmopt_mechanism_by_name(const char* name, void** mechanism);
int pkmopt_mechanism_from_file(const char* path, const char* limb_parameters, void** mechanism);
int pkmopt_mechanism_from_text(const char* toml, const char* file_name, const char* limb_parameters, void** mechanism);
int pkmopt_mechanism_with_masses(const void* mechanism, const char* model, void** other);
int pkmopt_mechanism_info(const void* mechanism, char** json);
int pkmopt_mechanism_text(const void* mechanism, char** toml);
void pkmopt_mechanism_free(void* mechanism);
int pkmopt_design_create(const void* mechanism, const double* parameters, const char* mode, const double* limits, void** design);
void pkmopt_design_free(void* design);
int pkmopt_design_inverse(const void* design, size_t count, const double* poses, double* joints, const void* options);
int pkmopt_design_jacobians(const void* design, size_t count, const double* poses, double* jacobians, const void* options);
int pkmopt_design_quantity(const void* design, const char* name, size_t count, const double* poses, double* values, const void* options);
int pkmopt_design_margin_names(const void* design, char** json);
int pkmopt_design_margins(const void* design, size_t count, const double* poses, double* margins, const void* options);
int pkmopt_design_forward(const void* design, size_t count, const double* joints, const double* near, size_t capacity, double* poses, size_t* found, const void* options);
int pkmopt_design_dynamics(const void* design, size_t count, const double* poses, const double* velocities, const double* accelerations, const double* wrenches, double* forces, double* inertia, double* coriolis, double* gravity, const void* options);
int pkmopt_design_link_names(const void* design, char** json);
int pkmopt_design_links(const void* design, size_t count, const double* poses, double* capsules, const void* options);
int pkmopt_study_from_file(const char* path, const char* changes, void** study);
int pkmopt_study_from_text(const char* toml, const char* file_name, const char* mechanism_toml, const char* mechanism_file_name, const char* changes, void** study);
int pkmopt_study_info(const void* study, char** json);
void pkmopt_study_free(void* study);
int pkmopt_study_set_functions(void* study, const void* functions);
int pkmopt_study_start_workers(void* study, const char* folder, const void* python, const void* options);
int pkmopt_hash(const char* bytes, size_t size, char** hash);
int pkmopt_study_evaluate(const void* study, size_t count, const double* designs, int complete, double* objectives, double* margins, double* outputs, uint8_t* status, const void* options);
int pkmopt_study_differentiate(const void* study, size_t count, const double* designs, double* objectives, double* margins, double* outputs, uint8_t* status, double* derivatives, const void* options);
int pkmopt_study_why_failed(const void* study, const double* design, char** sentence, const void* options);
int pkmopt_study_volume(const void* study, const double* parameters, double* volume, double* error, double* gradient, const void* options);
int pkmopt_study_fields(const void* study, const double* parameters, const char* mode, char** json, double** values, const void* options);
int pkmopt_study_surface(const void* study, const double* parameters, size_t* vertex_count, double** vertices, size_t* triangle_count, uint32_t** triangles, const void* options);
int pkmopt_study_run(const void* study, const char* path, int64_t seed, const void* options, char** json);
int pkmopt_study_resume(const char* path, int64_t generations, int64_t evaluations, const void* options, char** json);
int pkmopt_results_open(const char* path, void** results);
void pkmopt_results_free(void* results);
int pkmopt_results_info(const void* results, char** json);
int pkmopt_results_evaluations(const void* results, size_t stage, double* designs, double* objectives, double* margins, double* outputs, uint8_t* status, int64_t* generation, double* seconds);
int pkmopt_results_population(const void* results, size_t stage, int64_t generation, size_t* count, int64_t** rows);
int pkmopt_results_study(const void* results, void** study);
int pkmopt_report(size_t count, const char* const* paths, const char* output, int overwrite, const void* options);
int pkmopt_optimiser_names(char** json);
int pkmopt_optimiser_create(const char* options, size_t variables, const double* lower, const double* upper, const double* step, size_t objectives, const int* maximise, size_t margins, uint64_t seed, void** optimiser);
void pkmopt_optimiser_free(void* optimiser);
int pkmopt_optimiser_ask(void* optimiser, size_t* count, const double** designs, int* derivatives);
int pkmopt_optimiser_tell(void* optimiser, const double* objectives, const double* margins, const double* derivatives, const uint8_t* status);
int pkmopt_optimiser_evaluations(const void* optimiser, size_t* rows, double* designs, double* objectives, double* margins, uint8_t* status, int64_t* best);

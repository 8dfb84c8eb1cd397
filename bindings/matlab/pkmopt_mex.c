/* MEX function over pkmopt.h, for MATLAB and Octave. The classes and functions of the package pkmopt call it as
 * pkmopt_mex(COMMAND, ...); it is not meant to be called by users.
 *
 * A matrix has one row per pose, design or state; it is transposed here, because pkmopt.h stores row by row. JSON
 * becomes structs, cells and matrices here, because jsondecode() of Octave changes the last bits of numbers. An object
 * is a uint64 scalar, an index into a table: an object that was freed, or belongs to another session, is an error
 * instead of a wrong memory access. */
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <mex.h>
#include <pkmopt.h>

/* ---- Errors and interrupts ------------------------------------------------------------------------------------- */

/* mexErrMsgIdAndTxt() does not return; memory of mxMalloc() is freed by the interpreter. */
__attribute__((noreturn)) static void raise_error(const char* identifier, const char* text) {
  mexErrMsgIdAndTxt(identifier, "%s", text);
  abort();
}

__attribute__((noreturn, format(printf, 1, 2))) static void refuse(const char* format, ...) {
  static char text[2048];
  va_list values;
  va_start(values, format);
  vsnprintf(text, sizeof text, format, values);
  va_end(values);
  raise_error("pkmopt:invalidInput", text);
}

static void check(pkmopt_status status) {
  static const char* const identifiers[] = {NULL,
                                            "pkmopt:invalidInput",
                                            "pkmopt:fileError",
                                            "pkmopt:designError",
                                            "pkmopt:stopped",
                                            "pkmopt:noMemory",
                                            "pkmopt:internalError"};
  if (status == PKMOPT_OK) return;
  const bool is_known = (size_t)status < sizeof identifiers / sizeof *identifiers;
  raise_error(is_known ? identifiers[status] : "pkmopt:internalError", pkmopt_error());
}

/* They say whether the user has pressed Ctrl-C: a variable of Octave, and an undocumented function of MATLAB. The
 * address of the one that the running interpreter does not define is NULL. */
extern sig_atomic_t octave_interrupt_state __attribute__((weak));
extern bool utIsInterruptPending(void) __attribute__((weak));

static int is_interrupted(void* user) {
  (void)user;
  if (&octave_interrupt_state && *(volatile sig_atomic_t*)&octave_interrupt_state > 0) return 1;
  return utIsInterruptPending && utIsInterruptPending();
}

/* ---- Arguments and results of a call --------------------------------------------------------------------------- */

typedef struct Call {
  int result_count, argument_count;
  mxArray** results;
  const mxArray** arguments;
} Call;

static void give(const Call* call, int index, mxArray* value) {
  if (index == 0 || index < call->result_count)
    call->results[index] = value;
  else
    mxDestroyArray(value);
}

/* Returns the argument of a call at an index; NULL if it is [] or missing. */
static const mxArray* argument(const Call* call, int index) {
  if (index >= call->argument_count || (mxGetM(call->arguments[index]) == 0 && mxGetN(call->arguments[index]) == 0))
    return NULL;
  return call->arguments[index];
}

/* Returns a copy that the interpreter frees after the call. The result of mxArrayToString() is not always freed. */
static char* copied_text(const mxArray* text) {
  const size_t size = 4 * mxGetNumberOfElements(text) + 1; /* a character has at most 4 bytes in UTF-8 */
  char* const copy = mxCalloc(size, 1);
  if (size > 1) mxGetString(text, copy, size);
  return copy;
}

/* Returns the text argument at an index; NULL if it is [] or missing. */
static const char* text_of(const Call* call, int index, const char* what) {
  const bool is_text = index < call->argument_count && mxIsChar(call->arguments[index]);
  const mxArray* const value = is_text ? call->arguments[index] : argument(call, index);
  if (!value) return NULL;
  if (!mxIsChar(value) || mxGetM(value) > 1) refuse("%s is of class %s; expected a text", what, mxGetClassName(value));
  return copied_text(value);
}

static const char* required_text(const Call* call, int index, const char* what) {
  const char* const text = text_of(call, index, what);
  if (!text) refuse("%s is missing; expected a text", what);
  return text;
}

static double number_of(const Call* call, int index, const char* what, double otherwise) {
  const mxArray* const value = argument(call, index);
  if (!value) return otherwise;
  if (!(mxIsNumeric(value) || mxIsLogical(value)) || mxIsComplex(value) || mxGetNumberOfElements(value) != 1)
    refuse("%s is of class %s and has %d elements; expected a number", what, mxGetClassName(value),
           (int)mxGetNumberOfElements(value));
  return mxGetScalar(value);
}

static int64_t integer_of(const Call* call, int index, const char* what, int64_t minimum, int64_t otherwise) {
  if (!argument(call, index)) return otherwise;
  const double value = number_of(call, index, what, 0);
  if (!(value >= (double)minimum && value <= 9007199254740992.0) || value != floor(value))
    refuse("%s is %.15g; expected an integer of at least %lld", what, value, (long long)minimum);
  return (int64_t)value;
}

static pkmopt_options options_of(const Call* call, int index) {
  const int64_t threads = integer_of(call, index, "threads", 0, 0);
  if (threads > 100000) refuse("threads is %lld; expected at most 100000", (long long)threads);
  const pkmopt_options options = {(int)threads, is_interrupted, NULL};
  return options;
}

/* Number and names of the columns that a matrix argument must have; the names are quoted in error messages. */
typedef struct Columns {
  size_t count;
  char* names; /* separated by commas, such as "x, y, z" */
} Columns;

/* Copies a real matrix of MATLAB to an array that stores it row by row. */
static double* rows_of(const mxArray* value, const char* what, Columns columns, size_t* count) {
  const char* problem = NULL;
  if (!value)
    problem = "[] or missing";
  else if (!mxIsDouble(value) || mxIsComplex(value) || mxIsSparse(value))
    problem = mxIsDouble(value) ? "complex or sparse" : mxGetClassName(value);
  if (problem)
    refuse("%s is %s; expected a full real matrix of class double with %zu columns: %s", what, problem, columns.count,
           columns.names);
  const size_t row_count = mxGetM(value);
  if (mxGetNumberOfDimensions(value) != 2 || mxGetN(value) != columns.count)
    refuse("%s is %zu x %zu; expected %zu columns: %s", what, row_count, mxGetN(value), columns.count, columns.names);
  double* const rows = mxMalloc((row_count * columns.count + 1) * sizeof(double));
  const double* const from = mxGetPr(value);
  for (size_t j = 0; j < columns.count; ++j)
    for (size_t i = 0; i < row_count; ++i) rows[i * columns.count + j] = from[j * row_count + i];
  *count = row_count;
  return rows;
}

/* Returns one row for each of `count` poses; a matrix with a single row is repeated. NULL if it is [] or missing. */
static double* matching_rows(const mxArray* value, const char* what, Columns columns, size_t count) {
  if (!value) return NULL;
  size_t found;
  double* const rows = rows_of(value, what, columns, &found);
  if (found == count) return rows;
  if (found != 1) refuse("%s has %zu rows; expected %zu, one for each pose", what, found, count);
  double* const all = mxMalloc((count * columns.count + 1) * sizeof(double));
  for (size_t i = 0; i < count; ++i) memcpy(all + i * columns.count, rows, columns.count * sizeof(double));
  return all;
}

static double* new_rows(size_t count) { return mxMalloc((count + 1) * sizeof(double)); }

/* Creates a MATLAB array, of at least two dimensions, from values in `rows` whose last index varies fastest. */
static mxArray* array_of(const double* rows, mwSize dimensions, const mwSize* sizes) {
  mwSize all[16] = {1, 1};
  mwSize index[16] = {0};
  size_t strides[16], count = 1;
  for (mwSize k = 0; k < dimensions; ++k) all[k] = sizes[k];
  for (mwSize k = dimensions; k-- > 0; count *= sizes[k]) strides[k] = count;
  mxArray* const array = mxCreateNumericArray(dimensions < 2 ? 2 : dimensions, all, mxDOUBLE_CLASS, mxREAL);
  double* const values = mxGetPr(array);
  size_t from = 0;
  for (size_t to = 0; to < count; ++to) {
    values[to] = rows[from];
    for (mwSize k = 0; k < dimensions; ++k) {
      from += strides[k];
      if (++index[k] < sizes[k]) break;
      from -= strides[k] * sizes[k];
      index[k] = 0;
    }
  }
  return array;
}

static mxArray* matrix_of(const double* rows, size_t count, size_t width) {
  const mwSize sizes[2] = {count, width};
  return array_of(rows, 2, sizes);
}

static mxArray* cube_of(const double* rows, size_t count, size_t first, size_t second) {
  const mwSize sizes[3] = {count, first, second};
  return array_of(rows, 3, sizes);
}

static mxArray* column_of_bytes(const uint8_t* bytes, size_t count) {
  mxArray* const column = mxCreateNumericMatrix(count, 1, mxUINT8_CLASS, mxREAL);
  if (count > 0) memcpy(mxGetData(column), bytes, count);
  return column;
}

static mxArray* text_array(char* allocated) {
  mxArray* const text = mxCreateString(allocated);
  pkmopt_free(allocated);
  return text;
}

/* ---- JSON ------------------------------------------------------------------------------------------------------ */

static mxArray* json_value(const char** at);

__attribute__((noreturn)) static void refuse_json(void) {
  raise_error("pkmopt:internalError", "the library has returned a text that is not JSON");
}

static void skip(const char** at, char expected) {
  if (**at != expected) refuse_json();
  ++*at;
}

static char* json_text(const char** at) {
  skip(at, '"');
  char* const text = mxMalloc(strlen(*at) + 1); /* released or shortened below */
  size_t length = 0;
  while (**at != '"') {
    if (**at == '\0') refuse_json();
    if (**at != '\\') {
      text[length++] = *(*at)++;
      continue;
    }
    const char escaped = (*at)[1];
    static const char codes[] = "nrtbf", controls[] = "\n\r\t\b\f";
    const char* const code = strchr(codes, escaped);
    if (escaped == '\0') refuse_json();
    if (escaped == 'u') { /* the library escapes control characters only */
      char digits[5] = {0};
      strncpy(digits, *at + 2, 4);
      text[length++] = (char)strtol(digits, NULL, 16);
      *at += 2 + strlen(digits);
    } else {
      text[length++] = code ? controls[code - codes] : escaped;
      *at += 2;
    }
  }
  ++*at;
  text[length] = '\0';
  return mxRealloc(text, length + 1);
}

/* Converts a name to a valid field name of a struct: "workspace-volume" becomes workspace_volume, "4ppa" x4ppa. A
 * number is appended to a name that is already among `others`. */
static char* field_name(const char* name, char** others, size_t count) {
  char* const field = mxMalloc(64);
  const bool begins_with_letter = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z');
  snprintf(field, 56, "%s%s", begins_with_letter ? "" : "x", name); /* names of MATLAB have at most 63 characters */
  for (char* c = field; *c; ++c)
    if (!((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9'))) *c = '_';
  const size_t length = strlen(field);
  for (size_t i = 0, suffix = 2; i < count; ++i)
    if (strcmp(field, others[i]) == 0) {
      snprintf(field + length, 8, "_%zu", suffix++);
      i = (size_t)-1; /* compare the changed name with all others again */
    }
  return field;
}

static mxArray* json_object(const char** at) {
  char** names = NULL;
  mxArray** values = NULL;
  size_t count = 0;
  skip(at, '{');
  while (**at != '}') {
    if (count > 0) skip(at, ',');
    names = mxRealloc(names, (count + 1) * sizeof *names);
    values = mxRealloc(values, (count + 1) * sizeof *values);
    char* const name = json_text(at);
    names[count] = field_name(name, names, count);
    mxFree(name);
    skip(at, ':');
    values[count++] = json_value(at);
  }
  ++*at;
  mxArray* const object = mxCreateStructMatrix(1, 1, (int)count, (const char**)names);
  for (size_t i = 0; i < count; ++i) {
    mxSetFieldByNumber(object, 0, (int)i, values[i]);
    mxFree(names[i]);
  }
  mxFree(names);
  mxFree(values);
  return object;
}

/* Joins structs to a struct array that has the fields of all of them; missing fields are []. */
static mxArray* struct_array(mxArray** values, size_t count) {
  mxArray* const array = mxCreateStructMatrix(1, count, 0, NULL);
  for (size_t i = 0; i < count; ++i)
    for (int k = 0; k < mxGetNumberOfFields(values[i]); ++k) {
      const char* const name = mxGetFieldNameByNumber(values[i], k);
      if (mxGetFieldNumber(array, name) < 0) mxAddField(array, name);
      mxSetField(array, i, name, mxDuplicateArray(mxGetFieldByNumber(values[i], 0, k)));
    }
  for (size_t i = 0; i < count; ++i) mxDestroyArray(values[i]);
  return array;
}

/* Converts a JSON array: numbers become a row vector, in which null is NaN; objects become a struct array; all other
 * arrays become a cell row. */
static mxArray* json_array(const char** at) {
  mxArray** values = NULL;
  size_t count = 0, numbers = 0, nulls = 0, objects = 0;
  skip(at, '[');
  while (**at != ']') {
    if (count > 0) skip(at, ',');
    values = mxRealloc(values, (count + 1) * sizeof *values);
    mxArray* const value = json_value(at);
    values[count++] = value;
    numbers += mxIsDouble(value) && mxGetNumberOfElements(value) == 1;
    nulls += mxIsDouble(value) && mxGetNumberOfElements(value) == 0;
    objects += mxIsStruct(value) && mxGetNumberOfElements(value) == 1;
  }
  ++*at;
  mxArray* array;
  if (count > 0 && objects == count) {
    array = struct_array(values, count);
  } else if (numbers > 0 && numbers + nulls == count) {
    array = mxCreateDoubleMatrix(1, count, mxREAL);
    for (size_t i = 0; i < count; ++i) {
      mxGetPr(array)[i] = mxGetNumberOfElements(values[i]) == 1 ? mxGetScalar(values[i]) : NAN;
      mxDestroyArray(values[i]);
    }
  } else {
    array = mxCreateCellMatrix(1, count);
    for (size_t i = 0; i < count; ++i) mxSetCell(array, i, values[i]);
  }
  mxFree(values);
  return array;
}

/* Converts the JSON value at a position of a text, and moves the position behind it. The text has no spaces between its
 * tokens. */
static mxArray* json_value(const char** at) {
  static const struct {
    const char* word;
    int value;
  } words[] = {{"true", 1}, {"false", 0}, {"null", -1}};
  switch (**at) {
    case '{':
      return json_object(at);
    case '[':
      return json_array(at);
    case '"': {
      char* const text = json_text(at);
      mxArray* const value = mxCreateString(text);
      mxFree(text);
      return value;
    }
    default:
      break;
  }
  for (size_t i = 0; i < 3; ++i)
    if (strncmp(*at, words[i].word, strlen(words[i].word)) == 0) {
      *at += strlen(words[i].word);
      return words[i].value < 0 ? mxCreateDoubleMatrix(0, 0, mxREAL) : mxCreateLogicalScalar(words[i].value == 1);
    }
  char* end;
  const double number = strtod(*at, &end);
  if (end == *at) refuse_json();
  *at = end;
  return mxCreateDoubleScalar(number);
}

static mxArray* parsed(char* allocated) {
  char* const copy = mxMalloc(strlen(allocated) + 1); /* freed by the interpreter after an error */
  strcpy(copy, allocated);
  pkmopt_free(allocated);
  const char* at = copy;
  mxArray* const value = json_value(&at);
  mxFree(copy);
  return value;
}

/* ---- Objects --------------------------------------------------------------------------------------------------- */

typedef enum Kind { kNone, kMechanism, kDesign, kStudy, kResults, kKinds } Kind;
static const char* const kind_names[kKinds] = {"object", "mechanism", "design", "study", "study file"};
enum { kLists = 5 };
/* Indices of the lists in an object's description whose entries name the columns of matrices. */
enum { kParameters, kCoordinates, kJoints, kLimits }; /* of a mechanism or design */
enum {
  kVariables = kCoordinates,
  kObjectives = 2,
  kConstraints = 3,
  kOutputs = 4
}; /* of a study, which has kParameters, too */

typedef struct Object {
  uint64_t id; /* the serial number, and in the lowest kIndexBits bits the index into the table of objects */
  Kind kind;
  void* pointer;
  Columns columns[kLists];
  size_t stage_count, *stage_rows; /* numbers of stages and of their evaluations, of a study file */
} Object;

static Object* objects;
static size_t object_capacity;
static uint64_t next_serial;
enum { kIndexBits = 24 };

static void free_object(Object* object) {
  switch (object->kind) {
    case kMechanism:
      pkmopt_mechanism_free(object->pointer);
      break;
    case kDesign:
      pkmopt_design_free(object->pointer);
      break;
    case kStudy:
      pkmopt_study_free(object->pointer);
      break;
    case kResults:
      pkmopt_results_free(object->pointer);
      break;
    default:
      break;
  }
  for (size_t k = 0; k < kLists; ++k) free(object->columns[k].names);
  free(object->stage_rows);
  memset(object, 0, sizeof *object);
}

static void free_all(void) {
  for (size_t i = 0; i < object_capacity; ++i) free_object(&objects[i]);
  free(objects);
  objects = NULL;
  object_capacity = 0;
}

/* Returns a free place of the table of objects. It is reserved before the object of the library is created, because
 * entering that object must not fail: it would never be freed. */
static Object* new_object(void) {
  size_t index = 0;
  while (index < object_capacity && objects[index].kind != kNone) ++index;
  if (index >> kIndexBits) raise_error("pkmopt:noMemory", "there are too many objects");
  if (index == object_capacity) {
    const size_t capacity = 2 * object_capacity + 16;
    Object* const larger = realloc(objects, capacity * sizeof *objects);
    if (!larger) raise_error("pkmopt:noMemory", "out of memory");
    memset(larger + object_capacity, 0, (capacity - object_capacity) * sizeof *objects);
    objects = larger;
    object_capacity = capacity;
  }
  if (next_serial == 0) next_serial = (uint64_t)time(NULL) << 8; /* differs from the numbers of earlier sessions */
  objects[index].id = next_serial++ << kIndexBits | index;
  return &objects[index];
}

static Object* find_object(const mxArray* value) {
  if (!value || !mxIsUint64(value) || mxGetNumberOfElements(value) != 1) return NULL;
  const uint64_t id = *(const uint64_t*)mxGetData(value);
  const size_t index = id & ((1u << kIndexBits) - 1);
  if (index >= object_capacity || objects[index].id != id || objects[index].kind == kNone) return NULL;
  return &objects[index];
}

static const Object* object_of(const Call* call, int index, Kind kind) {
  const Object* const object = find_object(argument(call, index));
  if (!object || object->kind != kind)
    refuse("this %s has been deleted, or was loaded from a file of another session", kind_names[kind]);
  return object;
}

/* Returns the names in a list of a description; its entries are texts, or structs with the field `name`. */
static Columns columns_of(const mxArray* info, const char* list) {
  const mxArray* const entries = mxGetField(info, 0, list);
  if (!entries) raise_error("pkmopt:internalError", list);
  const size_t count = mxGetNumberOfElements(entries);
  Columns columns = {count, calloc(1, 64 * count + 1)};
  for (size_t i = 0; columns.names && i < count; ++i) {
    const mxArray* const name = mxIsStruct(entries) ? mxGetField(entries, i, "name") : mxGetCell(entries, i);
    if (name && mxIsChar(name))
      snprintf(columns.names + strlen(columns.names), 64, "%s%s", i > 0 ? ", " : "", copied_text(name));
  }
  if (!columns.names) raise_error("pkmopt:noMemory", "out of memory");
  return columns;
}

/* Enters an object of the library into its place in the table; the first result of the call is its id. */
static void enter(const Call* call, Object* object, Kind kind, void* pointer) {
  object->kind = kind;
  object->pointer = pointer;
  mxArray* const id = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
  *(uint64_t*)mxGetData(id) = object->id;
  give(call, 0, id);
}

/* Converts the JSON description that a function of the library has returned; after an error, frees the object. */
static mxArray* description(Object* object, pkmopt_status status, char* json) {
  if (status == PKMOPT_OK) return parsed(json);
  free_object(object);
  check(status);
  return NULL;
}

/* ---- Commands -------------------------------------------------------------------------------------------------- */

static void version(const Call* call) { give(call, 0, mxCreateString(pkmopt_version())); }

static void number(const Call* call) {
  double value;
  check(pkmopt_number(required_text(call, 0, "number"), required_text(call, 1, "unit"), &value));
  give(call, 0, mxCreateDoubleScalar(value));
}

/* Counts the objects that have not been freed, for tests. */
static void object_count(const Call* call) {
  size_t count = 0;
  for (size_t i = 0; i < object_capacity; ++i) count += objects[i].kind != kNone;
  give(call, 0, mxCreateDoubleScalar((double)count));
}

static void free_by_id(const Call* call) {
  Object* const object = find_object(argument(call, 0));
  if (object) free_object(object);
}

static void mechanism_names(const Call* call) {
  char* json;
  check(pkmopt_mechanism_names(&json));
  give(call, 0, parsed(json));
}

static void enter_mechanism(const Call* call, Object* object, pkmopt_mechanism* mechanism) {
  static const char* const lists[] = {"parameters", "coordinates", "joints", "limits"};
  enter(call, object, kMechanism, mechanism);
  char* json = NULL;
  const pkmopt_status status = pkmopt_mechanism_info(mechanism, &json);
  mxArray* const info = description(object, status, json);
  for (size_t k = 0; k < 4; ++k) object->columns[k] = columns_of(info, lists[k]);
  give(call, 1, info);
}

static void mechanism_by_name(const Call* call) {
  Object* const object = new_object();
  pkmopt_mechanism* mechanism;
  check(pkmopt_mechanism_by_name(required_text(call, 0, "name"), &mechanism));
  enter_mechanism(call, object, mechanism);
}

static void mechanism_from_file(const Call* call) {
  Object* const object = new_object();
  pkmopt_mechanism* mechanism;
  check(pkmopt_mechanism_from_file(required_text(call, 0, "file"), NULL, &mechanism));
  enter_mechanism(call, object, mechanism);
}

static void mechanism_from_text(const Call* call) {
  Object* const object = new_object();
  pkmopt_mechanism* mechanism;
  check(pkmopt_mechanism_from_text(required_text(call, 0, "text"), text_of(call, 1, "file name"),
                                   text_of(call, 2, "parameters of limbs"), &mechanism));
  enter_mechanism(call, object, mechanism);
}

static void mechanism_with_masses(const Call* call) {
  const void* const pointer = object_of(call, 0, kMechanism)->pointer;
  Object* const object = new_object();
  pkmopt_mechanism* mechanism;
  check(pkmopt_mechanism_with_masses(pointer, required_text(call, 1, "mass model"), &mechanism));
  enter_mechanism(call, object, mechanism);
}

static void mechanism_text(const Call* call) {
  char* text;
  check(pkmopt_mechanism_text(object_of(call, 0, kMechanism)->pointer, &text));
  give(call, 0, text_array(text));
}

/* Returns the argument at an index, a row vector of known length; NULL if it is [] or missing. */
static const double* row_of(const Call* call, int index, const char* what, Columns columns) {
  size_t count = 0;
  if (!argument(call, index)) return NULL;
  const double* const row = rows_of(argument(call, index), what, columns, &count);
  if (count != 1) refuse("%s has %zu rows; expected 1", what, count);
  return row;
}

static void design_create(const Call* call) {
  Object* const object = new_object();
  const Object* const mechanism = object_of(call, 0, kMechanism);
  pkmopt_design* design;
  check(pkmopt_design_create(mechanism->pointer, row_of(call, 1, "parameters", mechanism->columns[kParameters]),
                             text_of(call, 2, "mode"), row_of(call, 3, "limits", mechanism->columns[kLimits]),
                             &design));
  enter(call, object, kDesign, design);
  for (size_t k = 0; k < kLists; ++k) {
    object->columns[k].count = mechanism->columns[k].count;
    object->columns[k].names = mechanism->columns[k].names ? strdup(mechanism->columns[k].names) : NULL;
  }
}

/* Arguments of commands that evaluate a design at poses. */
typedef struct AtPoses {
  const pkmopt_design* design;
  size_t coordinates, joints, count;
  const double* poses;
  pkmopt_options options;
} AtPoses;

/* Reads the design from the first argument, the poses and the number of threads from arguments at the given indices. */
static AtPoses at_poses(const Call* call, int poses, int threads) {
  const Object* const design = object_of(call, 0, kDesign);
  AtPoses at = {.design = design->pointer,
                .coordinates = design->columns[kCoordinates].count,
                .joints = design->columns[kJoints].count,
                .options = options_of(call, threads)};
  at.poses = rows_of(argument(call, poses), "poses", design->columns[kCoordinates], &at.count);
  return at;
}

static void design_inverse(const Call* call) {
  const AtPoses at = at_poses(call, 1, 2);
  double* const joints = new_rows(at.count * at.joints);
  check(pkmopt_design_inverse(at.design, at.count, at.poses, joints, &at.options));
  give(call, 0, matrix_of(joints, at.count, at.joints));
}

static void design_jacobians(const Call* call) {
  const AtPoses at = at_poses(call, 1, 2);
  double* const jacobians = new_rows(at.count * at.joints * at.coordinates);
  check(pkmopt_design_jacobians(at.design, at.count, at.poses, jacobians, &at.options));
  give(call, 0, cube_of(jacobians, at.count, at.joints, at.coordinates));
}

static void design_quantity(const Call* call) {
  const AtPoses at = at_poses(call, 2, 3);
  double* const values = new_rows(at.count);
  check(pkmopt_design_quantity(at.design, required_text(call, 1, "quantity"), at.count, at.poses, values, &at.options));
  give(call, 0, matrix_of(values, at.count, 1));
}

static void design_margins(const Call* call) {
  const AtPoses at = at_poses(call, 1, 2);
  char* json;
  check(pkmopt_design_margin_names(at.design, &json));
  mxArray* const names = parsed(json);
  const size_t width = mxGetNumberOfElements(names);
  double* const margins = new_rows(at.count * width);
  check(pkmopt_design_margins(at.design, at.count, at.poses, margins, &at.options));
  give(call, 0, matrix_of(margins, at.count, width));
  give(call, 1, names);
}

static void design_forward(const Call* call) {
  const Object* const design = object_of(call, 0, kDesign);
  const size_t width = design->columns[kCoordinates].count;
  const pkmopt_options options = options_of(call, 3);
  size_t count, capacity = 16;
  const double* const joints = rows_of(argument(call, 1), "joints", design->columns[kJoints], &count);
  size_t* const found = mxMalloc((count + 1) * sizeof *found);
  double* poses;
  if (argument(call, 2)) {
    size_t near_count;
    const double* const near = rows_of(argument(call, 2), "near", design->columns[kCoordinates], &near_count);
    if (near_count != count) refuse("near has %zu rows and joints has %zu; expected as many", near_count, count);
    poses = new_rows(count * width);
    check(pkmopt_design_forward(design->pointer, count, joints, near, 1, poses, found, &options));
    give(call, 0, matrix_of(poses, count, width));
    return;
  }
  for (size_t most = 0;; most = 0) {
    poses = new_rows(count * capacity * width);
    check(pkmopt_design_forward(design->pointer, count, joints, NULL, capacity, poses, found, &options));
    for (size_t i = 0; i < count; ++i)
      if (found[i] > most) most = found[i];
    if (most <= capacity) break;
    capacity = most;
    mxFree(poses);
  }
  mxArray* const cells = mxCreateCellMatrix(count, 1);
  for (size_t i = 0; i < count; ++i) mxSetCell(cells, i, matrix_of(poses + i * capacity * width, found[i], width));
  give(call, 0, cells);
}

/* Arguments: design, poses, velocities, accelerations, wrenches, threads. */
static void design_dynamics(const Call* call) {
  static char wrench[] = "Fx, Fy, Fz, Mx, My, Mz";
  const AtPoses at = at_poses(call, 1, 5);
  const Columns coordinates = object_of(call, 0, kDesign)->columns[kCoordinates], forces_and_moments = {6, wrench};
  const double* const velocities = matching_rows(argument(call, 2), "velocities", coordinates, at.count);
  const double* const accelerations = matching_rows(argument(call, 3), "accelerations", coordinates, at.count);
  const double* const wrenches = matching_rows(argument(call, 4), "wrenches", forces_and_moments, at.count);
  const size_t n = at.joints;
  double* const forces = new_rows(at.count * n);
  double* const inertia = new_rows(at.count * n * n);
  double* const coriolis = new_rows(at.count * n);
  double* const gravity = new_rows(at.count * n);
  check(pkmopt_design_dynamics(at.design, at.count, at.poses, velocities, accelerations, wrenches, forces, inertia,
                               coriolis, gravity, &at.options));
  give(call, 0, matrix_of(forces, at.count, n));
  give(call, 1, cube_of(inertia, at.count, n, n));
  give(call, 2, matrix_of(coriolis, at.count, n));
  give(call, 3, matrix_of(gravity, at.count, n));
}

static void design_links(const Call* call) {
  const AtPoses at = at_poses(call, 1, 2);
  char* json;
  check(pkmopt_design_link_names(at.design, &json));
  mxArray* const names = parsed(json);
  const size_t width = mxGetNumberOfElements(names);
  double* const capsules = new_rows(at.count * width * 7);
  check(pkmopt_design_links(at.design, at.count, at.poses, capsules, &at.options));
  give(call, 0, cube_of(capsules, at.count, width, 7));
  give(call, 1, names);
}

static void set_study_columns(Object* object, const mxArray* info) {
  static const char* const lists[] = {"parameters", "variables", "objectives", "constraints", "outputs"};
  for (size_t k = 0; k < kLists; ++k) object->columns[k] = columns_of(info, lists[k]);
}

static void enter_study(const Call* call, Object* object, pkmopt_study* study) {
  enter(call, object, kStudy, study);
  char* json = NULL;
  const pkmopt_status status = pkmopt_study_info(study, &json);
  mxArray* const info = description(object, status, json);
  set_study_columns(object, info);
  give(call, 1, info);
}

static void study_from_file(const Call* call) {
  Object* const object = new_object();
  pkmopt_study* study;
  check(pkmopt_study_from_file(required_text(call, 0, "file"), text_of(call, 1, "changes"), &study));
  enter_study(call, object, study);
}

/* Arguments: text, file name, text and file name of the mechanism file, changes. */
static void study_from_text(const Call* call) {
  Object* const object = new_object();
  pkmopt_study* study;
  check(pkmopt_study_from_text(required_text(call, 0, "text"), text_of(call, 1, "file name"),
                               text_of(call, 2, "text of the mechanism file"),
                               text_of(call, 3, "name of the mechanism file"), text_of(call, 4, "changes"), &study));
  enter_study(call, object, study);
}

/* Arguments: study, designs, complete, threads; or study, designs, [], threads for derivatives. */
static void evaluate(const Call* call, bool with_derivatives) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_options options = options_of(call, 3);
  const int complete = number_of(call, 2, "complete", 1) != 0;
  const size_t variables = study->columns[kVariables].count, objectives = study->columns[kObjectives].count;
  const size_t constraints = study->columns[kConstraints].count, outputs = study->columns[kOutputs].count;
  size_t count;
  const double* const designs = rows_of(argument(call, 1), "designs", study->columns[kVariables], &count);
  double* const f = new_rows(count * objectives);
  double* const g = new_rows(count * constraints);
  double* const h = new_rows(count * outputs);
  uint8_t* const status = mxMalloc(count + 1);
  if (!with_derivatives) {
    check(pkmopt_study_evaluate(study->pointer, count, designs, complete, f, g, h, status, &options));
  } else {
    const size_t values = objectives + constraints;
    double* const all = new_rows(count * values * (1 + variables));
    check(pkmopt_study_differentiate(study->pointer, count, designs, f, g, h, status, all, &options));
    double* const of_objectives = new_rows(count * objectives * variables);
    double* const of_constraints = new_rows(count * constraints * variables);
    for (size_t i = 0; i < count; ++i)
      for (size_t k = 0; k < values; ++k)
        memcpy(k < objectives ? of_objectives + (i * objectives + k) * variables
                              : of_constraints + (i * constraints + k - objectives) * variables,
               all + (i * values + k) * (1 + variables) + 1, variables * sizeof(double));
    give(call, 4, cube_of(of_objectives, count, objectives, variables));
    give(call, 5, cube_of(of_constraints, count, constraints, variables));
  }
  give(call, 0, matrix_of(f, count, objectives));
  give(call, 1, matrix_of(g, count, constraints));
  give(call, 2, column_of_bytes(status, count));
  give(call, 3, matrix_of(h, count, outputs));
}

static void study_evaluate(const Call* call) { evaluate(call, false); }
static void study_differentiate(const Call* call) { evaluate(call, true); }

static void study_why_failed(const Call* call) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_options options = options_of(call, 2);
  const double* const design = row_of(call, 1, "design", study->columns[kVariables]);
  if (!design) refuse("design is missing; expected a row of %s", study->columns[kVariables].names);
  char* sentence;
  check(pkmopt_study_why_failed(study->pointer, design, &sentence, &options));
  give(call, 0, text_array(sentence));
}

/* Returns the values of all parameters of the study's mechanism from the argument at an index. */
static const double* parameters_of(const Call* call, int index, const Object* study) {
  const double* const parameters = row_of(call, index, "parameters", study->columns[kParameters]);
  if (!parameters) refuse("parameters are missing; expected a row of %s", study->columns[kParameters].names);
  return parameters;
}

/* Arguments: study, parameters, threads. Results: volume, gradient, relative error. */
static void study_volume(const Call* call) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_options options = options_of(call, 2);
  const double* const parameters = parameters_of(call, 1, study);
  double* const gradient = call->result_count > 1 ? new_rows(study->columns[kParameters].count) : NULL;
  double volume, error;
  check(pkmopt_study_volume(study->pointer, parameters, &volume, &error, gradient, &options));
  give(call, 0, mxCreateDoubleScalar(volume));
  if (gradient) give(call, 1, matrix_of(gradient, 1, study->columns[kParameters].count));
  give(call, 2, mxCreateDoubleScalar(error));
}

/* Arguments: study, parameters, mode, threads. Results: description, and a cell with the array of each field. */
static void study_fields(const Call* call) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_options options = options_of(call, 3);
  char* json;
  double* values;
  check(pkmopt_study_fields(study->pointer, parameters_of(call, 1, study), text_of(call, 2, "mode"), &json, &values,
                            &options));
  mxArray* const info = parsed(json);
  const mxArray *const axes = mxGetField(info, 0, "axes"), *const fields = mxGetField(info, 0, "fields");
  const size_t field_count = mxGetNumberOfElements(fields);
  mwSize cells[16];
  size_t dimensions = 0;
  size_t cell_count = 1;
  for (; dimensions < mxGetNumberOfElements(axes); ++dimensions) {
    cells[dimensions] = (mwSize)mxGetScalar(mxGetField(axes, dimensions, "cells"));
    cell_count *= cells[dimensions];
  }
  mxArray* const arrays = mxCreateCellMatrix(1, field_count);
  for (size_t k = 0; k < field_count; ++k) mxSetCell(arrays, k, array_of(values + k * cell_count, dimensions, cells));
  pkmopt_free(values);
  give(call, 0, info);
  give(call, 1, arrays);
}

/* Arguments: study, parameters, threads. Results: vertices, and triangles as rows of indices from 1. */
static void study_surface(const Call* call) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_options options = options_of(call, 2);
  size_t vertex_count, triangle_count;
  double* vertices;
  uint32_t* triangles;
  check(pkmopt_study_surface(study->pointer, parameters_of(call, 1, study), &vertex_count, &vertices, &triangle_count,
                             &triangles, &options));
  give(call, 0, matrix_of(vertices, vertex_count, 3));
  pkmopt_free(vertices);
  mxArray* const indices = mxCreateDoubleMatrix(triangle_count, 3, mxREAL);
  for (size_t i = 0; i < triangle_count; ++i)
    for (size_t k = 0; k < 3; ++k) mxGetPr(indices)[k * triangle_count + i] = triangles[3 * i + k] + 1.0;
  pkmopt_free(triangles);
  give(call, 1, indices);
}

/* Arguments: study, file, seed, overwrite, time limit, threads. */
static void study_run(const Call* call) {
  const Object* const study = object_of(call, 0, kStudy);
  const pkmopt_run_options options = {.common = options_of(call, 5),
                                      .time_limit = number_of(call, 4, "time limit", 0),
                                      .overwrite = number_of(call, 3, "overwrite", 0) != 0};
  char* json;
  check(pkmopt_study_run(study->pointer, required_text(call, 1, "file"), integer_of(call, 2, "seed", 0, -1), &options,
                         &json));
  give(call, 0, parsed(json));
}

/* Arguments: file, generations, evaluations, time limit, threads. */
static void study_resume(const Call* call) {
  const pkmopt_run_options options = {.common = options_of(call, 4), .time_limit = number_of(call, 3, "time limit", 0)};
  char* json;
  check(pkmopt_study_resume(required_text(call, 0, "file"), integer_of(call, 1, "generations", 0, 0),
                            integer_of(call, 2, "evaluations", 0, 0), &options, &json));
  give(call, 0, parsed(json));
}

/* Argument: file. Results: id, description of the file, description of its study or [] if the study cannot be read. */
static void results_open(const Call* call) {
  Object* const object = new_object();
  pkmopt_results* results;
  check(pkmopt_results_open(required_text(call, 0, "file"), &results));
  enter(call, object, kResults, results);
  char* json = NULL;
  pkmopt_status status = pkmopt_results_info(results, &json);
  mxArray* const info = description(object, status, json);
  const mxArray *const tables = mxGetField(info, 0, "tables"), *const reason = mxGetField(info, 0, "why_unreadable");
  const size_t stage_count = mxGetNumberOfElements(tables);
  object->stage_rows = calloc(stage_count + 1, sizeof *object->stage_rows);
  if (!object->stage_rows) raise_error("pkmopt:noMemory", "out of memory");
  object->stage_count = stage_count;
  for (size_t k = 0; k < stage_count; ++k) object->stage_rows[k] = (size_t)mxGetScalar(mxGetField(tables, k, "rows"));
  if (call->result_count > 2 && mxIsEmpty(reason)) {
    pkmopt_study* study;
    status = pkmopt_results_study(results, &study);
    if (status == PKMOPT_OK) {
      status = pkmopt_study_info(study, &json);
      pkmopt_study_free(study);
    }
    mxArray* const study_info = description(object, status, json);
    set_study_columns(object, study_info);
    give(call, 2, study_info);
  } else {
    give(call, 2, mxCreateDoubleMatrix(0, 0, mxREAL));
  }
  give(call, 1, info);
}

/* Returns the index from 0 of the stage whose number from 1 is the second argument. */
static size_t stage_of(const Call* call, const Object* results) {
  const int64_t stage = integer_of(call, 1, "stage", 1, (int64_t)results->stage_count);
  if ((size_t)stage > results->stage_count)
    refuse("stage is %lld; expected at most %zu", (long long)stage, results->stage_count);
  return (size_t)stage - 1;
}

/* Arguments: study file, stage. Results: designs, objectives, constraints, outputs, status, generation, seconds. */
static void results_evaluations(const Call* call) {
  const Object* const results = object_of(call, 0, kResults);
  const size_t stage = stage_of(call, results), rows = results->stage_rows[stage];
  if (!results->columns[kVariables].names)
    raise_error("pkmopt:fileError", "the study of this file cannot be read; info.why_unreadable says why");
  double* blocks[4];
  for (size_t k = 0; k < 4; ++k) blocks[k] = new_rows(rows * results->columns[kVariables + k].count);
  uint8_t* const status = mxMalloc(rows + 1);
  int64_t* const generation = mxMalloc((rows + 1) * sizeof *generation);
  mxArray* const seconds = mxCreateDoubleMatrix(rows, 1, mxREAL);
  check(pkmopt_results_evaluations(results->pointer, stage, blocks[0], blocks[1], blocks[2], blocks[3], status,
                                   generation, mxGetPr(seconds)));
  for (size_t k = 0; k < 4; ++k) give(call, (int)k, matrix_of(blocks[k], rows, results->columns[kVariables + k].count));
  give(call, 4, column_of_bytes(status, rows));
  mxArray* const generations = mxCreateDoubleMatrix(rows, 1, mxREAL);
  for (size_t i = 0; i < rows; ++i) mxGetPr(generations)[i] = (double)generation[i];
  give(call, 5, generations);
  give(call, 6, seconds);
}

/* Arguments: study file, stage, generation; without generation, the Pareto front. Result: rows, from 1. */
static void results_population(const Call* call) {
  const Object* const results = object_of(call, 0, kResults);
  const size_t stage = stage_of(call, results);
  const int64_t generation = argument(call, 2) ? integer_of(call, 2, "generation", 0, 0) : -1;
  size_t count;
  int64_t* rows;
  check(pkmopt_results_population(results->pointer, stage, generation, &count, &rows));
  mxArray* const column = mxCreateDoubleMatrix(count, 1, mxREAL);
  for (size_t i = 0; i < count; ++i) mxGetPr(column)[i] = (double)rows[i] + 1;
  pkmopt_free(rows);
  give(call, 0, column);
}

static void results_study(const Call* call) {
  const void* const results = object_of(call, 0, kResults)->pointer;
  Object* const object = new_object();
  pkmopt_study* study;
  check(pkmopt_results_study(results, &study));
  enter_study(call, object, study);
}

/* Arguments: file, page, overwrite. */
static void report(const Call* call) {
  const pkmopt_options options = options_of(call, 3);
  const char* const file = required_text(call, 0, "file");
  check(pkmopt_report(1, &file, required_text(call, 1, "page"), number_of(call, 2, "overwrite", 0) != 0, &options));
}

static const struct {
  const char* name;
  void (*run)(const Call* call);
} commands[] = {
    {"version", version},
    {"number", number},
    {"object_count", object_count},
    {"free", free_by_id},
    {"mechanism_names", mechanism_names},
    {"mechanism_by_name", mechanism_by_name},
    {"mechanism_from_file", mechanism_from_file},
    {"mechanism_from_text", mechanism_from_text},
    {"mechanism_with_masses", mechanism_with_masses},
    {"mechanism_text", mechanism_text},
    {"design_create", design_create},
    {"design_inverse", design_inverse},
    {"design_jacobians", design_jacobians},
    {"design_quantity", design_quantity},
    {"design_margins", design_margins},
    {"design_forward", design_forward},
    {"design_dynamics", design_dynamics},
    {"design_links", design_links},
    {"study_from_file", study_from_file},
    {"study_from_text", study_from_text},
    {"study_evaluate", study_evaluate},
    {"study_differentiate", study_differentiate},
    {"study_why_failed", study_why_failed},
    {"study_volume", study_volume},
    {"study_fields", study_fields},
    {"study_surface", study_surface},
    {"study_run", study_run},
    {"study_resume", study_resume},
    {"results_open", results_open},
    {"results_evaluations", results_evaluations},
    {"results_population", results_population},
    {"results_study", results_study},
    {"report", report},
};

void mexFunction(int result_count, mxArray* results[], int argument_count, const mxArray* arguments[]) {
  if (!mexIsLocked()) { /* stays loaded, so that `clear all` neither frees objects in use nor ends running threads */
    mexLock();
    mexAtExit(free_all);
  }
  const Call whole = {result_count, argument_count, results, arguments};
  const Call call = {result_count, argument_count - 1, results, arguments + 1};
  const char* const command = required_text(&whole, 0, "command");
  for (size_t i = 0; i < sizeof commands / sizeof *commands; ++i)
    if (strcmp(command, commands[i].name) == 0) {
      commands[i].run(&call);
      return;
    }
  refuse("unknown command '%s'; use the functions of the package pkmopt", command);
}

// Language-independent input of the code generators of `pkmopt generate`: the functions of a mechanism as nodes of an
// expression graph, and sample poses with the engine's values, for a test of the generated code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/expression/graph.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::code {

/// A scalar, vector or matrix that a generated function computes; its elements are stored row by row.
struct Output {
  std::string name;  ///< name in the generated code, for example "J"
  std::size_t rows = 1, columns = 1;
  std::vector<expression::Node> nodes;
};

/// A function of the pose in the generated code; `equations` also depends on the rates of the coordinates.
struct Function {
  std::string name;     ///< name in the generated code, for example "jacobian"
  std::string meaning;  ///< one sentence for the generated documentation
  std::vector<Output> outputs;
};

/// The values that the engine computes at one pose, which a test compares with those of the generated code.
struct Sample {
  std::vector<double> pose, velocity, acceleration;
  std::vector<double> wrench;  ///< load on the platform with six components [N, N m]
  std::vector<double> start;   ///< a nearby pose, from which Newton's method for the forward kinematics starts
  std::vector<double> joints, jacobian, margins, quantities;
  std::vector<double> forces;  ///< forces of the joints; empty if the mechanism has no masses
};

struct Options {
  bool has_parameters = false;    ///< true: parameters are arguments of every function; false: they are constants
  bool single_precision = false;  ///< true: generated numbers are float; false: double
  std::size_t samples = 20;       ///< number of test poses; fewer if fewer feasible ones are found
};

/// The array element that the generated code reads as one of the inputs of the expression graph.
struct InputPlace {
  char array = 0;  ///< array that contains the element: 'p' parameters, 'x' pose, 'v' rates; 0: the input is not used
  std::size_t index = 0;
};

struct NamedUnit {
  std::string name, unit, meaning;
};

struct Module {
  std::string name;  ///< valid identifier, for example "rotary_delta"
  /// Title of the generated files, for example "rotary-delta, default design, mode ..; by pkmopt 0.1.0".
  std::string title;
  Options options;
  expression::Graph graph;
  std::vector<InputPlace> inputs;  ///< one element for each input of `graph`
  std::vector<NamedUnit> parameters, coordinates, joints, margins, quantities;
  std::vector<double> design;  ///< values of all parameters of the mechanism [SI]

  /// Computes q, and `assembly`: values that are all >= 0 if the mechanism can be assembled at the pose.
  Function inverse;
  Function jacobian;                  ///< computes the Jacobian J
  Function limits;                    ///< computes the margins of the pose
  std::optional<Function> values;     ///< computes the quantities of the pose; std::nullopt: there are none
  std::optional<Function> equations;  ///< computes J, Jdot_v, M, h, G and Jw of the equations of motion
  /// True if the mechanism has as many joints as coordinates, so that forward kinematics can be generated.
  bool has_forward = false;
  std::vector<std::string> left_out;  ///< sentences that describe what the generated functions omit
  std::vector<Sample> samples;
};

/// Writes the functions of a design as an expression graph. Throws std::invalid_argument with one sentence if the
/// mechanism is not described by formulas, DesignError if no feasible pose is found.
/// @param title  title of the generated files
Module module_of(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                 const std::string& mode, const Options& options, const std::string& title);

}  // namespace pkm::code

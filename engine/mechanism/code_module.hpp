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

/// A value or an array that a function computes; arrays are stored row by row.
struct Output {
  std::string name;  ///< "J"
  std::size_t rows = 1, columns = 1;
  std::vector<expression::Node> nodes;
};

/// A function of the pose; `equations` also depends on the rates of the coordinates.
struct Function {
  std::string name;     ///< "jacobian"
  std::string meaning;  ///< one sentence
  std::vector<Output> outputs;
};

/// Values computed by the engine at a pose.
struct Sample {
  std::vector<double> pose, velocity, acceleration;
  std::vector<double> wrench;  ///< six components
  std::vector<double> start;   ///< a pose nearby, at which the iteration of the forward kinematics starts
  std::vector<double> joints, jacobian, margins, quantities;
  std::vector<double> forces;  ///< empty if the mechanism has no masses
};

struct Options {
  bool has_parameters = false;    ///< true: parameters are arguments of every function; false: they are constants
  bool single_precision = false;  ///< float instead of double
  std::size_t samples = 20;       ///< number of test poses; fewer if fewer feasible ones are found
};

/// The element of a function's arguments that corresponds to an input of the graph.
struct InputPlace {
  char array = 0;  ///< 'p': parameters, 'x': pose, 'v': rates; 0: the input is not used
  std::size_t index = 0;
};

struct NamedUnit {
  std::string name, unit, meaning;
};

struct Module {
  std::string name;   ///< an identifier: "rotary_delta"
  std::string title;  ///< "rotary-delta, default design, mode ..; by pkmopt 0.1.0"
  Options options;
  expression::Graph graph;
  std::vector<InputPlace> inputs;  ///< for each input of the graph
  std::vector<NamedUnit> parameters, coordinates, joints, margins, quantities;
  std::vector<double> design;  ///< values of the parameters

  Function inverse;                   ///< outputs q, and `assembly`: values that are all >= 0 if the mechanism can be
                                      ///< assembled at the pose
  Function jacobian;                  ///< output J
  Function limits;                    ///< output margins
  std::optional<Function> values;     ///< output quantities
  std::optional<Function> equations;  ///< equations of motion: outputs J, Jdot_v, M, h, G, Jw
  bool has_forward = false;           ///< true if there are as many joints as coordinates
  std::vector<std::string> left_out;  ///< sentences on what the functions do not include
  std::vector<Sample> samples;
};

/// Collects the functions of a design. Throws std::invalid_argument with one sentence for mechanisms that are not
/// described by formulas, DesignError if no feasible pose is found.
/// @param title  title of the generated files
Module module_of(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                 const std::string& mode, const Options& options, const std::string& title);

}  // namespace pkm::code

// What `pkmopt generate` writes, before it is written in a language: functions of a mechanism as nodes of an expression
// graph, and poses with their values for a test of the written code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/expression/graph.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::code {

/// A value or an array that a formula of a function computes, row by row.
struct Output {
  std::string name;  ///< "J"
  std::size_t rows = 1, columns = 1;
  std::vector<expression::Node> nodes;
};

/// A function of the pose; `equations` is one of the rates of the coordinates, too.
struct Function {
  std::string name;     ///< "jacobian"
  std::string meaning;  ///< one sentence
  std::vector<Output> outputs;
};

/// Values of the engine at a pose.
struct Sample {
  std::vector<double> pose, velocity, acceleration;
  std::vector<double> wrench;  ///< 6
  std::vector<double> start;   ///< a pose nearby, where the search of the forward kinematics starts
  std::vector<double> joints, jacobian, margins, quantities;
  std::vector<double> forces;  ///< empty if the mechanism has no masses
};

struct Options {
  bool has_parameters = false;    ///< parameters are arguments of every function; otherwise constants
  bool single_precision = false;  ///< float instead of double
  std::size_t samples = 20;       ///< poses of the test; fewer if fewer feasible ones are found
};

/// The element of a function's arguments that an input of the graph is.
struct InputPlace {
  char array = 0;  ///< 'p': parameters, 'x': pose, 'v': rates; 0: not in use
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
  std::vector<InputPlace> inputs;  ///< by index of the graph's input
  std::vector<NamedUnit> parameters, coordinates, joints, margins, quantities;
  std::vector<double> design;  ///< values of the parameters

  Function inverse;                   ///< outputs q, and `assembly`: the constraints under which the pose assembles
  Function jacobian;                  ///< output J
  Function limits;                    ///< output margins
  std::optional<Function> values;     ///< output quantities
  std::optional<Function> equations;  ///< of motion: outputs J, Jdot_v, M, h, G, Jw
  bool has_forward = false;           ///< as many joints as coordinates
  std::vector<std::string> left_out;  ///< sentences on what the functions do not contain
  std::vector<Sample> samples;
};

/// Collects the functions of a design. Throws std::invalid_argument with one sentence for mechanisms that are not
/// described by formulas, DesignError if no feasible pose is found.
/// @param title  of the written files
Module module_of(const Mechanism& mechanism, std::span<const double> parameters, const LimitSpec& limits,
                 const std::string& mode, const Options& options, const std::string& title);

}  // namespace pkm::code

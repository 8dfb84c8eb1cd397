// What C and C++ share: expressions, and the bodies of functions.
#pragma once

#include <string>

#include "engine/export/code/statements.hpp"

namespace pkm::code {

extern const Syntax kSyntaxOfC;

/// Definitions of the helper functions that expressions call, and of the solver of linear systems, for a type `real`;
/// "@inline" stands for the words before a function that is local to the file.
std::string helpers_of_c();

/// The statements that compute the outputs of a function into arrays of their names, indented by two spaces.
std::string body_of_c(const Module& module, const Function& function);
/// The condition under which the inverse kinematics assembles, in terms of the arrays q and assembly.
std::string assembly_condition(const Module& module);
/// The body of `forward`: Newton's method. @param locals  declares the arrays found, J, change and next; @param
/// inverse_of_x, inverse_of_next, jacobian  calls of the functions; @param J, found  pointers to the arrays
std::string forward_body_of_c(const Module& module, const std::string& locals, const std::string& inverse_of_x,
                              const std::string& inverse_of_next, const std::string& jacobian, const std::string& J,
                              const std::string& found);
/// The body of `forces`: solves the equations of motion. Parameters as above.
std::string forces_body_of_c(const Module& module, const std::string& locals, const std::string& equations,
                             const std::string& transposed, const std::string& tau);
/// Lines of a comment on the arrays, each after `mark`.
std::string arrays_comment(const Module& module, const std::string& mark);

/// Whether there is a function that computes drive forces.
inline bool has_forces(const Module& module) { return module.equations && module.has_forward; }

/// What differs between the test programs in C and in C++.
struct TestSyntax {
  std::string begin;                                                ///< #include lines
  std::string prefix;                                               ///< of the names of functions
  std::string main;                                                 ///< "int main(void)"
  std::string (*array)(const std::string& name, std::size_t size);  ///< its declaration without "static const"
  std::string (*row)(const std::string& numbers);                   ///< an initialiser
  std::string (*pointer)(const std::string& array);                 ///< to the first element
};

/// The test program: it compares all functions with stored values, prints the largest difference, relative to values
/// above 1, and returns 1 if it exceeds 1e-10, or 1e-2 in single precision.
std::string test_of_c(const Module& module, const TestSyntax& syntax);

}  // namespace pkm::code

// What C and C++ share: expressions, and the bodies of functions.
#pragma once

#include <string>

#include "engine/export/code/statements.hpp"

namespace pkm::code {

extern const Syntax kSyntaxOfC;

/// Definitions of the helper functions that expressions call, and of the solver of linear systems, for a type `real`.
/// "@inline" is a placeholder for the specifiers of a function that is local to the file ("static inline" in C).
std::string helpers_of_c();

/// Statements, indented by two spaces, that compute the outputs of a function and store them in arrays with the names
/// of the outputs.
std::string body_of_c(const Module& module, const Function& function);
/// The condition that the inverse kinematics has a solution, in terms of the arrays q and assembly.
std::string assembly_condition(const Module& module);
/// The body of `forward`, which applies Newton's method.
/// @param locals  declarations of the arrays found, J, change and next
/// @param inverse_of_x, inverse_of_next, jacobian  calls of these functions
/// @param J, found  expressions that give pointers to these arrays
std::string forward_body_of_c(const Module& module, const std::string& locals, const std::string& inverse_of_x,
                              const std::string& inverse_of_next, const std::string& jacobian, const std::string& J,
                              const std::string& found);
/// The body of `forces`: solves the equations of motion. Parameters as above.
std::string forces_body_of_c(const Module& module, const std::string& locals, const std::string& equations,
                             const std::string& transposed, const std::string& tau);
/// A comment that describes the arrays; each line begins with `mark`.
std::string arrays_comment(const Module& module, const std::string& mark);

/// Whether there is a function that computes drive forces.
inline bool has_forces(const Module& module) { return module.equations && module.has_forward; }

/// The parts of the test program that differ between C and C++.
struct TestSyntax {
  std::string begin;                                                ///< #include lines
  std::string prefix;                                               ///< prefix of function names
  std::string main;                                                 ///< "int main(void)"
  std::string (*array)(const std::string& name, std::size_t size);  ///< declaration of an array, without "static const"
  std::string (*row)(const std::string& numbers);                   ///< initialiser of an array
  std::string (*pointer)(const std::string& array);                 ///< pointer to the first element of an array
};

/// The test program. It compares the results of all functions with stored values and prints the largest difference
/// (relative for values above 1). It returns 1 if the difference exceeds 1e-10, or 1e-2 in single precision.
std::string test_of_c(const Module& module, const TestSyntax& syntax);

}  // namespace pkm::code

// Parts of code generation that C and C++ share: expressions, and the bodies of functions.
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
/// C expression that is true if the inverse kinematics has a solution, in terms of the arrays q and assembly.
std::string assembly_condition(const Module& module);
/// The body of `forward`, which applies Newton's method.
/// @param locals  declarations of the arrays found, J, change and next
/// @param inverse_of_x, inverse_of_next, jacobian  calls of the generated functions for inverse kinematics and Jacobian
/// @param J, found  expressions that give pointers to these arrays
std::string forward_body_of_c(const Module& module, const std::string& locals, const std::string& inverse_of_x,
                              const std::string& inverse_of_next, const std::string& jacobian, const std::string& J,
                              const std::string& found);
/// The body of `forces`, which solves the equations of motion for the drive forces.
/// @param locals  declarations of the arrays J, Jdot_v, M, h, G, Jw and transposed
/// @param equations  call of the function `equations`
/// @param transposed, tau  expressions that give pointers to these arrays
std::string forces_body_of_c(const Module& module, const std::string& locals, const std::string& equations,
                             const std::string& transposed, const std::string& tau);
/// A comment that describes the arrays of the generated functions; each line begins with `mark`.
std::string arrays_comment(const Module& module, const std::string& mark);

/// Returns true if a function that computes drive forces is generated.
inline bool has_forces(const Module& module) { return module.equations && module.has_forward; }

/// The parts of the generated test program that differ between C and C++.
struct TestSyntax {
  std::string begin;   ///< #include lines at the beginning of the program
  std::string prefix;  ///< prefix of the names of the generated functions
  std::string main;    ///< head of the main function, for example "int main(void)"
  /// Writes the declaration of an array, without "static const".
  std::string (*array)(const std::string& name, std::size_t size);
  std::string (*row)(const std::string& numbers);    ///< writes the initialiser of an array
  std::string (*pointer)(const std::string& array);  ///< writes a pointer to the first element of an array
};

/// The text of the test program. The program compares the results of all functions with stored values and prints the
/// largest difference (relative for values above 1). Its exit code is 1 if the difference exceeds 1e-10, or 1e-2 in
/// single precision.
std::string test_of_c(const Module& module, const TestSyntax& syntax);

}  // namespace pkm::code

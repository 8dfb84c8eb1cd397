/* Workspace and best design of a rotary Delta through the C interface of pkmopt:
 *   cc example.c -lpkmopt -o example && ./example rotary-delta.toml */
#include <pkmopt.h>
#include <stdio.h>
#include <stdlib.h>

static void check(pkmopt_status status) {
  if (status == PKMOPT_OK) return;
  fprintf(stderr, "%s\n", pkmopt_error());
  exit(EXIT_FAILURE);
}

int main(int argc, char** argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: %s MECHANISM.toml\n", argv[0]);
    return EXIT_FAILURE;
  }
  pkmopt_mechanism* robot;
  pkmopt_design* design;
  check(pkmopt_mechanism_from_file(argv[1], NULL, &robot));
  check(pkmopt_design_create(robot, NULL, NULL, NULL, &design));

  const double pose[3] = {0.05, 0, -0.4};
  double joints[3], index;
  check(pkmopt_design_inverse(design, 1, pose, joints, NULL));
  check(pkmopt_design_quantity(design, "lti", 1, pose, &index, NULL));
  printf("joints %.6f %.6f %.6f rad, transmission index %.6f\n", joints[0], joints[1], joints[2], index);

  /* The best lengths of the cranks and rods, by a genetic algorithm that asks for designs. */
  char* text;
  pkmopt_study* problem;
  check(pkmopt_mechanism_text(robot, &text));
  check(pkmopt_study_from_text("[mechanism]\nfile = 'robot.toml'\n"
                               "[variables]\nl_a = { min = '150 mm', max = '400 mm' }\n"
                               "l_b = { min = '400 mm', max = '900 mm' }\n"
                               "[[objective]]\ntype = 'workspace-volume'\n"
                               "[[constraint]]\ntype = 'expression'\nname = 'length'\nunit = 'm'\n"
                               "expression = '0.8 - l_a - l_b'\n",
                               "problem.toml", text, "robot.toml", NULL, &problem));
  pkmopt_free(text);
  const double lower[2] = {0.15, 0.4}, upper[2] = {0.4, 0.9};
  const int maximise = 1;
  pkmopt_optimiser* optimiser;
  check(pkmopt_optimiser_create("optimiser = 'ga'\npopulation = 20\ngenerations = 15", 2, lower, upper, NULL, 1,
                                &maximise, 1, 1, &optimiser));
  for (;;) {
    size_t count;
    const double* designs;
    int needs_derivatives;
    double values[20], margins[20];
    uint8_t status[20];
    check(pkmopt_optimiser_ask(optimiser, &count, &designs, &needs_derivatives));
    if (count == 0) break;
    check(pkmopt_study_evaluate(problem, count, designs, 0, values, margins, NULL, status, NULL));
    check(pkmopt_optimiser_tell(optimiser, values, margins, NULL, status));
  }
  size_t rows;
  int64_t best;
  check(pkmopt_optimiser_evaluations(optimiser, &rows, NULL, NULL, NULL, NULL, &best));
  double* designs = malloc(2 * rows * sizeof *designs);
  double* volumes = malloc(rows * sizeof *volumes);
  check(pkmopt_optimiser_evaluations(optimiser, &rows, designs, volumes, NULL, NULL, &best));
  printf("best of %zu designs: l_a %.3f m, l_b %.3f m, %.4f m^3\n", rows, designs[2 * best], designs[2 * best + 1],
         volumes[best]);
  free(designs);
  free(volumes);
  pkmopt_optimiser_free(optimiser);
  pkmopt_study_free(problem);
  pkmopt_design_free(design);
  pkmopt_mechanism_free(robot);
  return EXIT_SUCCESS;
}

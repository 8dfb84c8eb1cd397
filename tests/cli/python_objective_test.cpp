// Objectives, constraints and outputs that are functions in Python, called by worker processes.
#include <gmock/gmock.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

// Functions that fail, that end their process, that return nothing; and a method.
// it.
constexpr const char* kFunctions = R"(
import math, os

def price(design):
    print("does not mix with the output")
    return 3 * design["a"] + design["b"]

def distance(design):
    return math.hypot(design["a"] - 0.3, design["b"] - 0.8)

def root(x):
    return math.sqrt(x)

def partial(design):
    return root(0.35 - design["a"])

def deadly(design):
    if design["a"] > 0.4:
        os._exit(3)
    return design["a"]

def nothing(design):
    pass

class Weights:
    @staticmethod
    def total(design):
        return 2 * design["b"]
)";

std::string study_of(const std::string& call, const std::string& stage = "optimiser = \"ga\"\npopulation = 20\n") {
  return R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.2, max = 0.5 }
b = { min = 0.5, max = 1 }
[[objective]]
type = "python"
call = ")" +
         call + R"("
[[constraint]]
type = "python"
call = "functions.py:price"
max = 1.9
[[output]]
type = "python"
call = "functions.py:Weights.total"
unit = "m"
[[output]]
type = "workspace-volume"
[[stage]]
)" + stage;
}

class PythonObjective : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    write("functions.py", kFunctions);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  /// Runs the program and expects success.
  void expect_run(const std::vector<std::string>& arguments) { ASSERT_EQ(run(arguments), 0) << output_; }
  void expect_refused(const std::string& call, const std::string& sentence) {
    write("study.toml", study_of(call));
    EXPECT_EQ(run({"run", "study.toml", "-o", "refused.h5"}), 2) << output_;
    EXPECT_THAT(output_, HasSubstr(sentence));
    EXPECT_FALSE(fs::exists(path("refused.h5")));
  }
};

TEST_F(PythonObjective, ResultsDoNotDependOnWorkersAndThreads) {
  write("study.toml", study_of("functions.py:distance", "optimiser = \"ga\"\npopulation = 20\ngenerations = 15\n"));
  expect_run({"run", "study.toml", "-o", "one.h5", "--quiet", "--threads", "1", "--workers", "1"});
  expect_run({"run", "study.toml", "-o", "many.h5", "--quiet", "--threads", "2", "--workers", "3"});
  const StudyContents contents = read("one.h5");
  EXPECT_EQ(first_difference(contents, read("many.h5")), "");
  const EvaluationTable& table = contents.stages[0].table;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double a = table.design(row)[0], b = table.design(row)[1];
    ASSERT_NEAR(table.objective_row(row)[0], std::hypot(a - 0.3, b - 0.8), 1e-15);
    ASSERT_EQ(table.margin_row(row)[0], 1.9 - (3 * a + b));
    ASSERT_EQ(table.output_row(row)[0], 2 * b);
    ASSERT_EQ(table.status[row], table.margin_row(row)[0] >= 0 ? Status::feasible : Status::infeasible);
  }
  const ProgramResult evaluated = pkmopt({"evaluate", "study.toml", "--json"}, folder_);
  EXPECT_TRUE(evaluated.json()["feasible"]);
  EXPECT_THAT(evaluated.err, HasSubstr("does not mix"));
}

TEST_F(PythonObjective, AFailedCallIsAFailedDesignWithItsTraceback) {
  write("study.toml", study_of("functions.py:partial"));
  expect_run({"run", "study.toml", "-o", "partial.h5"});
  const std::string reason =
      "functions.py:partial: ValueError: math domain error (functions.py:12 in root, called from functions.py:15 in "
      "partial)";
  EXPECT_THAT(output_, HasSubstr(reason));
  const EvaluationTable table = read("partial.h5").stages[0].table;
  std::size_t failed = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    ASSERT_EQ(table.status[row] == Status::failed, table.design(row)[0] > 0.35);
    ASSERT_EQ(std::isnan(table.objective_row(row)[0]), table.status[row] == Status::failed);
    failed += table.status[row] == Status::failed;
  }
  EXPECT_GT(failed, 5u);
  EXPECT_EQ(run({"evaluate", "study.toml", "--set", "a=0.4,b=0.6"}), 1);
  EXPECT_THAT(output_, HasSubstr(reason));
  EXPECT_EQ(run({"evaluate", "study.toml", "--set", "a=0.3,b=0.6"}), 0) << output_;
}

TEST_F(PythonObjective, AFunctionThatEndsItsProcessFailsOnlyItsDesign) {
  write("study.toml", study_of("functions.py:deadly", "optimiser = \"sweep\"\npoints = 6\n"));
  expect_run({"run", "study.toml", "-o", "deadly.h5", "--workers", "1"});
  EXPECT_THAT(output_, HasSubstr("Python ended during the call (exit code 3)"));
  const EvaluationTable table = read("deadly.h5").stages[0].table;
  for (std::size_t row = 0; row < table.size(); ++row)
    ASSERT_EQ(table.status[row] == Status::failed, table.design(row)[0] > 0.4) << row;
}

TEST_F(PythonObjective, WithoutAValueNoDesignIsFeasible) {
  write("study.toml", study_of("functions.py:nothing"));
  EXPECT_EQ(run({"run", "study.toml", "-o", "nothing.h5"}), 4);
  EXPECT_THAT(output_, HasSubstr("the function returned None; expected a number"));
}

TEST_F(PythonObjective, ResumingNeedsTheSameFile) {
  fs::create_directory(path("folder"));
  fs::rename(path("functions.py"), path("folder/functions.py"));
  const std::string stage = "optimiser = \"ga\"\npopulation = 20\ngenerations = 40\n";
  write("folder/study.toml", study_of("functions.py:distance", stage));
  expect_run({"run", "folder/study.toml", "-o", "whole.h5", "--quiet"});
  write("folder/study.toml", study_of("functions.py:distance", stage + "[checkpoint]\nevery = 0\n"));
  {
    ChildProcess child(command({"run", "folder/study.toml", "-o", "killed.h5", "--quiet"}), folder_);
    while (!fs::exists(path("killed.h5"))) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    child.signal(SIGKILL);
    child.wait();
  }
  ASSERT_NE(read("killed.h5").state, StudyState::finished);
  for (const std::string text : {"", "def distance(design):\n    return 0\n"}) {  // changed, then missing
    write("folder/functions.py", std::string(kFunctions) + text + "# changed");
    EXPECT_EQ(run({"resume", "killed.h5"}), 1);
    EXPECT_THAT(output_, HasSubstr("folder/functions.py was changed after the study was started"));
  }
  fs::remove(path("folder/functions.py"));
  EXPECT_EQ(run({"resume", "killed.h5"}), 2);
  EXPECT_THAT(output_, HasSubstr("there is no file folder/functions.py or functions.py"));
  // Nothing but running needs the functions, and they may have moved beside the study file.
  expect_run({"show", "killed.h5"});
  expect_run({"export", "killed.h5", "--csv", "tables"});
  write("functions.py", kFunctions);
  expect_run({"resume", "killed.h5", "--quiet", "--workers", "2"});
  const StudyContents whole = read("whole.h5"), resumed = read("killed.h5");
  EXPECT_EQ(whole.stages[0].table.objectives, resumed.stages[0].table.objectives);
  EXPECT_EQ(whole.stages[0].table.designs, resumed.stages[0].table.designs);
  ASSERT_TRUE(resumed.functions);
  EXPECT_EQ(resumed.functions->size(), 3u);
}

TEST_F(PythonObjective, MistakesAreRefusedBeforeAnythingRuns) {
  expect_refused("missing.py:distance", "call = \"missing.py:distance\": there is no file missing.py");
  expect_refused("functions.py:distanc", "it has no function distanc; did you mean distance?");
  expect_refused("functions.py:math", "math is not a function");
  expect_refused("distance", "a function of a file is \"FILE.py:FUNCTION\"");
  expect_refused("functions.txt:distance", "names no function; expected \"FILE.py:FUNCTION\"");
  write("broken.py", "def f(design):\n  return 1\nraise RuntimeError('while loading')\n");
  expect_refused("broken.py:f", "RuntimeError: while loading (broken.py:3 in <module>)");
  write("study.toml", study_of("functions.py:distance", "optimiser = \"nlopt\"\nalgorithm = \"slsqp\"\n"));
  EXPECT_EQ(run({"run", "study.toml"}), 2);
  EXPECT_THAT(output_, HasSubstr("the Python function functions.py:distance has none; use an optimiser without"));
}

TEST_F(PythonObjective, SolversWithoutGradientsCallFunctionsFromConcurrentStarts) {
  std::string study = study_of("functions.py:distance",
                               "optimiser = \"nlopt\"\nalgorithm = \"bobyqa\"\nstarts = 4\nevaluations = 60\n");
  study.erase(study.find("[[constraint]]"), study.find("[[output]]") - study.find("[[constraint]]"));
  write("study.toml", study);
  expect_run({"run", "study.toml", "-o", "two.h5", "--quiet", "--threads", "2", "--workers", "2"});
  expect_run({"run", "study.toml", "-o", "one.h5", "--quiet", "--threads", "1", "--workers", "1"});
  EXPECT_EQ(first_difference(read("one.h5"), read("two.h5")), "");
}

constexpr const char* kEndless = R"(
def endless(design):
    if design["a"] > 0.4:
        with open("pid", "w") as file:
            print(os.getpid(), file=file)
        while True:
            pass
    return design["a"]
)";

TEST_F(PythonObjective, WorkersEndWithTheProgramThatIsKilled) {
  write("functions.py", std::string(kFunctions) + kEndless);
  write("study.toml", study_of("functions.py:endless", "optimiser = \"sweep\"\npoints = 9\n"));
  pid_t worker = 0;
  {
    ChildProcess child(command({"run", "study.toml", "-o", "endless.h5", "--quiet", "--workers", "1"}), folder_);
    while (!(std::ifstream(path("pid")) >> worker)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    child.signal(SIGKILL);
    child.wait();
  }
  const auto is_running = [&] {  // a process that has ended, but has not been waited for, has no command line
    std::ifstream file("/proc/" + std::to_string(worker) + "/cmdline");
    return file.peek() != std::ifstream::traits_type::eof();
  };
  for (int i = 0; i < 500 && is_running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(is_running()) << worker;
}

TEST_F(PythonObjective, CtrlCEndsACallThatTakesLong) {
  write("functions.py", std::string(kFunctions) + kEndless);
  write("study.toml", study_of("functions.py:endless", "optimiser = \"sweep\"\npoints = 9\n"));
  ChildProcess child(command({"run", "study.toml", "-o", "endless.h5", "--quiet", "--workers", "1"}), folder_);
  while (!fs::exists(path("pid"))) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  child.signal(SIGINT);
  EXPECT_EQ(child.wait(), 3) << child.output();
  const StudyContents contents = read("endless.h5");
  EXPECT_EQ(contents.state, StudyState::interrupted);
  for (std::size_t row = 0; row < contents.stages[0].table.size(); ++row)
    EXPECT_TRUE(std::isfinite(contents.stages[0].table.objective_row(row)[0]));
}

}  // namespace
}  // namespace pkm::testing

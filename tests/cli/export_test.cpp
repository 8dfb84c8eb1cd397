// `pkmopt export` and `workspace`: CSV tables, VTK images and STL surfaces, read back and compared.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "engine/config/built_in_mechanisms.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class ExportProgram : public StudyProgram {
 protected:
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void spill(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }
  /// Runs a small voxel study with a baseline into study.h5.
  void run_study() {
    spill("study.toml",
          "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 }\nb = { min = 0.7, max = 1.5 "
          "}\n[workspace]\nmethod = \"voxels\"\ncells = { x = 12, z = 14, theta = 16 }\nlimits = { beta_max = 1.2 }\n"
          "[baseline]\na = 0.21\n[[objective]]\ntype = \"workspace-ratio\"\n[[constraint]]\ntype = \"rail-length\"\n"
          "[[stage]]\noptimiser = \"ga\"\npopulation = 8\ngenerations = 3\n");
    ASSERT_EQ(run({"run", "study.toml", "--output", "study.h5", "--quiet"}), 0) << output_;
  }
  std::vector<std::string> lines(const std::string& name) const {
    std::vector<std::string> all;
    std::istringstream text(slurp(name));
    for (std::string line; std::getline(text, line);) all.push_back(line);
    return all;
  }
  /// Output of tests/python/read_vtk.py.
  std::string vtk(const std::string& arguments) const {
    const std::string command = "cd '" + folder_ + "' && /usr/bin/python3 '" + PKM_TEST_DATA +
                                "/../python/read_vtk.py' " + arguments + " > python.txt 2>&1";
    const int code = std::system(command.c_str());
    return (code == 0 ? "" : "failed: ") + slurp("python.txt");
  }
  static bool has_vtk() { return std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOHDF' 2>/dev/null") == 0; }
};

/// Triangles of a binary STL file: the normal, then three vertices.
std::vector<std::array<std::array<float, 3>, 4>> triangles_of(const std::string& stl) {
  std::uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, 4);
  EXPECT_EQ(stl.size(), 84 + 50 * static_cast<std::size_t>(count));
  std::vector<std::array<std::array<float, 3>, 4>> triangles(count);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&triangles[i], stl.data() + 84 + 50 * i, 48);
  return triangles;
}

/// Volume enclosed by the surface of a binary STL file (divergence theorem).
double volume_of(const std::string& stl) {
  double sixfold = 0;
  for (const auto& [normal, p, q, r] : triangles_of(stl))
    sixfold += static_cast<double>(p[0]) * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
               p[2] * (q[0] * r[1] - q[1] * r[0]);
  return sixfold / 6;
}

TEST_F(ExportProgram, VtkAndCsvOfAnyMechanismAgree) {
  if (!has_vtk()) GTEST_SKIP() << "python3-vtk9 is missing";
  for (const auto& mechanism : all_mechanisms()) {
    const MechanismInfo& info = mechanism->info();
    std::string cells;
    const std::vector<int>& swept = info.sweeps.front().swept;
    for (const int axis : swept)
      cells += (cells.empty() ? "" : ",") + info.coordinates[static_cast<std::size_t>(axis)].name + "=" +
               std::to_string(9 + axis);
    ASSERT_EQ(run({"workspace", info.name, "--cells", cells, "--vtk", "w.vtkhdf", "--csv", "w.csv", "--force"}), 0)
        << output_;
    EXPECT_THAT(output_, HasSubstr("wrote w.vtkhdf\nwrote w.csv\n"));
    const int count = (9 + swept[0]) * (9 + swept[1]) * (9 + swept[2]);
    const auto formulas = std::ranges::count_if(
        info.quantities, [](const QuantityInfo& quantity) { return quantity.of_pose != nullptr; });
    const auto arrays = (mechanism->dynamics() ? 13 : 7) + formulas;
    EXPECT_EQ(vtk("w.vtkhdf w.csv"),
              "equal " + std::to_string(count) + " cells of " + std::to_string(arrays) + " arrays\n")
        << info.name;
  }
}

TEST_F(ExportProgram, SurfacesOfAnyMechanismsWorkspaceAreClosed) {
  for (const auto& mechanism : all_mechanisms()) {
    const std::string& name = mechanism->info().name;
    SCOPED_TRACE(name);
    ASSERT_EQ(run({"workspace", name, "--stl", "."}), 0) << output_;
    const std::string stl = slurp(name + "-nominal.stl");
    using Vertex = std::array<float, 3>;
    std::map<std::pair<Vertex, Vertex>, int> edges;
    for (const auto& [normal, p, q, r] : triangles_of(stl))
      for (const auto& edge : {std::pair(p, q), std::pair(q, r), std::pair(r, p)}) ++edges[edge];
    for (const auto& [edge, times] : edges) ASSERT_EQ(edges[std::pair(edge.second, edge.first)], times);
    ASSERT_EQ(run({"evaluate", name, "--json"}), 0) << output_;  // on exact columns
    EXPECT_NEAR(volume_of(stl) / Json::parse(output_)["workspace"]["volume"].get<double>(), 1, 0.004);
  }
}

TEST_F(ExportProgram, TooManyCellsAreRejectedBeforeTheEvaluation) {
  run_study();
  StudyContents contents = read("study.h5");
  const auto at = contents.toml.find("x = 12, z = 14, theta = 16");
  contents.toml.replace(at, 26, "x = 800, z = 800, theta = 20");
  contents.text_digest.clear();  // as in files before schema 5
  write_study(path("study.h5"), contents);
  for (const char* const option : {"--vtk", "--stl"}) {
    EXPECT_EQ(run({"export", "study.h5", option, "w"}), 2);
    EXPECT_EQ(output_,
              "pkmopt: [workspace] cells: found 12800000 cells; expected at most 1e+07 to write; 'pkmopt workspace "
              "--cells' overrides them\n");
    EXPECT_FALSE(fs::exists(path("w")));
  }
  EXPECT_EQ(run({"export", "study.h5", "--csv", "tables"}), 0) << output_;
}

TEST_F(ExportProgram, WorkspaceAndEvaluateAgree) {
  run_study();
  ASSERT_EQ(run({"evaluate", "study.toml", "--set", "a=0.25", "--json"}), 0) << output_;
  const Json evaluated = Json::parse(output_);
  ASSERT_EQ(run({"workspace", "study.toml", "--set", "a=0.25", "--json"}), 0) << output_;
  const Json workspace = Json::parse(output_);
  EXPECT_EQ(workspace["feasible_cells"], evaluated["workspace"]["feasible_cells"]);
  EXPECT_NEAR(workspace["volume"].get<double>() / evaluated["workspace"]["volume"].get<double>(), 1, 1e-12);
  EXPECT_EQ(workspace["unit"], "m^2 rad");
  EXPECT_EQ(workspace["design"], "the baseline with a=0.25");
  EXPECT_EQ(workspace["axes"][2]["name"], "theta");
  EXPECT_EQ(workspace["axes"][2]["cells"], 16);
  EXPECT_EQ(workspace["fixed"][0]["value"], 1.25);
  EXPECT_GT(workspace["fields"]["conditioning"]["greatest"].get<double>(), 0.1);
  EXPECT_LT(workspace["fields"]["margin"]["least"].get<double>(), 0);
  ASSERT_EQ(run({"workspace", "study.toml"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("extent of the feasible cells"));
  EXPECT_THAT(output_, HasSubstr("dci_worst"));
}

TEST_F(ExportProgram, RoundingErrorsInTheExtentArePrintedAsZero) {
  ASSERT_EQ(run({"workspace", "3crr-r-cru", "--cells", "x=8,y=8,z=8"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("  y    0 .. 400 mm "));
  EXPECT_THAT(output_, HasSubstr(" of 0 .. 400 mm "));
}

TEST_F(ExportProgram, AnotherCoordinateCanBeFixed) {
  ASSERT_EQ(run({"workspace", "3crr-r-cru", "--fixed", "z=200mm", "--cells", "x=8,y=8,phi=9", "--box",
                 "x=0:0.3,y=0.1:0.4,phi=-30deg:30deg", "--json"}),
            0)
      << output_;
  const Json workspace = Json::parse(output_);
  EXPECT_EQ(workspace["fixed"][0]["name"], "z");
  EXPECT_EQ(workspace["fixed"][0]["value"], 0.2);
  EXPECT_EQ(workspace["unit"], "m^2 rad");
  EXPECT_EQ(workspace["axes"][2]["unit"], "rad");
  EXPECT_EQ(workspace["touches_box"], true);
  ASSERT_EQ(run({"workspace", "3crr-r-cru", "--fixed", "z=0.2,x=0.1", "--cells", "8", "--json"}), 0) << output_;
  EXPECT_EQ(Json::parse(output_)["unit"], "m rad");
  EXPECT_EQ(run({"workspace", "3crr-r-cru", "--fixed", "z=0.2,x=0.1,y=0.1,phi=0"}), 2);
  EXPECT_THAT(output_, HasSubstr("expected coordinates that can be fixed together, with their values"));
  EXPECT_EQ(run({"workspace", "4ppa-2par", "--cells", "x=1000,z=1000,theta=1000"}), 2);
  EXPECT_THAT(output_, HasSubstr("--cells: found 1e+09 cells; expected at most 1e+07"));
}

TEST_F(ExportProgram, WritesTablesImageAndSurfaceOfAStudy) {
  run_study();
  ASSERT_EQ(run({"export", "study.h5", "--csv", "tables/of/it", "--vtk", "best.vtkhdf", "--stl", "cad"}), 0) << output_;
  EXPECT_EQ(output_,
            "workspace of the best design\nwrote tables/of/it/evaluations.csv\nwrote tables/of/it/generations.csv\n"
            "wrote tables/of/it/populations.csv\nwrote tables/of/it/best.csv\nwrote best.vtkhdf\n"
            "wrote cad/4ppa-2par-best.stl\n");
  const StudyContents study = read("study.h5");
  const auto evaluations = lines("tables/of/it/evaluations.csv");
  ASSERT_EQ(evaluations.size(), 1 + study.stages[0].table.size());
  EXPECT_THAT(evaluations[0], HasSubstr("a [m],b [m],objective workspace-ratio [rad],margin rail-length [m]"));
  EXPECT_EQ(lines("tables/of/it/generations.csv").size(), 1 + study.stages[0].generations.size());

  // the image has the same cells as the voxel map in the study file
  const auto& map = study.final->map->voxels;
  const double feasible = static_cast<double>(std::count(map.feasible.begin(), map.feasible.end(), 1));
  const std::string stl = slurp("cad/4ppa-2par-best.stl");
  EXPECT_THAT(stl.substr(0, 80), HasSubstr("workspace of 4ppa-2par, the best design of study study"));
  EXPECT_NEAR(volume_of(stl) / study.final->best->volume, 1, 0.1);
  for (const auto& [normal, p, q, r] : triangles_of(stl))
    ASSERT_LT(std::fabs(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] - 1), 1e-5);
  if (!has_vtk()) GTEST_SKIP() << "python3-vtk9 is missing";
  const std::string read = vtk("best.vtkhdf");
  EXPECT_THAT(read, HasSubstr("dimensions 12 14 16\n"));
  const std::size_t begin = read.find("feasible "), end = read.find('\n', begin);
  double counted = 0;  // 1.0 as a hexadecimal bit pattern
  for (std::size_t at = read.find("3ff0000000000000", begin); at < end; at = read.find("3ff0000000000000", at + 1))
    ++counted;
  EXPECT_EQ(counted, feasible);
}

TEST_F(ExportProgram, AStudyWithColumnsIsExportedWithinItsBox) {
  spill(
      "study.toml",
      "[mechanism]\ntype = \"3crr-r-cru\"\n[variables]\nl_11 = { min = 0.16, max = 0.18 }\n[workspace]\nmethod = "
      "\"columns\"\nphi = \"10 deg\"\nbox = { x = [0.1, 0.2], y = [0.1, 0.3], z = [0.15, 0.25] }\n[[objective]]\ntype "
      "= \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\npopulation = 4\ngenerations = 1\n");
  ASSERT_EQ(run({"run", "study.toml", "--output", "study.h5", "--quiet"}), 0) << output_;
  const StudyContents study = read("study.h5");
  EXPECT_EQ(study.final->map->voxels.lower[2], 0.15);  // the voxel map in the file is restricted to the box, too
  EXPECT_EQ(study.final->map->voxels.upper[2], 0.25);
  ASSERT_EQ(run({"workspace", "--from", "study.h5", "--json"}), 0) << output_;
  const Json workspace = Json::parse(output_);
  EXPECT_EQ(workspace["axes"][1]["lower"], 0.1);
  EXPECT_EQ(workspace["axes"][1]["upper"], 0.3);
  EXPECT_EQ(workspace["cells"], 48 * 48 * 48);
  EXPECT_NEAR(workspace["fixed"][0]["value"].get<double>(), 0.174532925199433, 1e-12);
  EXPECT_NEAR(workspace["volume"].get<double>() / study.final->best->volume, 1, 0.02);
  ASSERT_EQ(run({"export", "study.h5", "--stl", "."}), 0) << output_;
  EXPECT_NEAR(volume_of(slurp("3crr-r-cru-best.stl")) / study.final->best->volume, 1, 0.02);
}

TEST_F(ExportProgram, AnyDesignOfAStudyCanBeSelected) {
  run_study();
  const StudyContents study = read("study.h5");
  const GenerationRecords& generations = study.stages[0].generations;
  const auto row = static_cast<std::size_t>(generations.population_of(2)[4]);
  ASSERT_EQ(run({"export", "study.h5", "--generation", "2", "--individual", "5", "--stl", "."}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("workspace of individual 5 of generation 2 of stage 1\n"));
  ASSERT_EQ(run({"export", "study.h5", "--baseline", "--stl", "."}), 0) << output_;
  EXPECT_TRUE(fs::exists(path("4ppa-2par-stage-1-generation-2-individual-5.stl")));
  EXPECT_TRUE(fs::exists(path("4ppa-2par-baseline.stl")));
  ASSERT_EQ(run({"evaluate", "--from", "study.h5", "--generation", "2", "--individual", "5", "--json"}), 0) << output_;
  EXPECT_EQ(Json::parse(output_)["parameters"]["a"], study.stages[0].table.design(row)[0]);
  ASSERT_EQ(run({"workspace", "--from", "study.h5", "--baseline", "--json"}), 0) << output_;
  EXPECT_EQ(Json::parse(output_)["parameters"]["a"], 0.21);
  EXPECT_EQ(run({"export", "study.h5", "--generation", "9", "--individual", "1", "--stl", "."}), 2);
  EXPECT_THAT(output_, HasSubstr("--generation: found 9; expected a generation of stage 1, 0 to 3"));
  EXPECT_EQ(run({"export", "study.h5", "--baseline", "--csv", "t"}), 2);
  EXPECT_THAT(output_, HasSubstr("--baseline: selects a design for --vtk, --stl, --urdf, --sdf or --mjcf"));
  EXPECT_EQ(run({"export", "study.h5"}), 2);
  EXPECT_THAT(output_,
              HasSubstr("export: found no output; expected at least one of --vtk, --csv, --stl, --urdf, --sdf, "
                        "--mjcf"));
}

TEST_F(ExportProgram, ModelsForSimulationAreThoseOfTheDesign) {
  spill("delta.toml", "[mechanism]\nfile = \"" PKM_EXPERIMENTS
                      "/mechanisms/rotary-delta.toml\"\n"
                      R"([variables]
l_b = { min = "450 mm", max = "600 mm" }
[workspace]
method = "voxels"
cells = { x = 6, y = 6, z = 6 }
[baseline]
l_b = "512 mm"
[[drive_train]]
joint = "all"
gear = 10
rotor_inertia = "1e-4 kg m^2"
viscous = "0.25 N m s/rad"
peak_force = "70 N m"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "ga"
population = 4
generations = 1
)");
  ASSERT_EQ(run({"run", "delta.toml", "--output", "study.h5", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"export", "study.h5", "--baseline", "-o", "m.urdf", "-o", "m.sdf", "-o", "m.xml"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("model of the baseline\nwrote m.urdf\nwrote m.yaml\nwrote m.sdf\nwrote m.xml\n"));
  EXPECT_THAT(slurp("m.xml"), HasSubstr("<!-- rotary-delta, the baseline of study delta. Units are"));
  EXPECT_THAT(slurp("m.xml"), HasSubstr("armature=\"0.01\" damping=\"0.25\""));
  EXPECT_THAT(slurp("m.xml"), HasSubstr("ctrlrange=\"-70 70\""));
  EXPECT_THAT(slurp("m.urdf"), HasSubstr("effort=\"70\""));
  // pose writes the same model for the same pose and parameters
  ASSERT_EQ(run({"export", "study.h5", "--baseline", "--at", "x=0,y=0.1,z=-0.45", "--mjcf", "a.xml"}), 0) << output_;
  ASSERT_EQ(run({"pose", "--from", "study.h5", "--baseline", "--at", "x=0,y=0.1,z=-0.45", "--mjcf", "b.xml"}), 0)
      << output_;
  const auto body = [&](const std::string& name) {
    const std::string text = slurp(name);
    return text.substr(text.find("<compiler"));
  };
  EXPECT_EQ(body("a.xml"), body("b.xml"));
  EXPECT_NE(body("a.xml"), body("m.xml"));  // another reference pose

  EXPECT_EQ(run({"export", "study.h5", "--baseline", "--mjcf", "a.xml"}), 1);
  EXPECT_THAT(output_, HasSubstr("a.xml exists already"));
  EXPECT_EQ(run({"export", "study.h5", "--csv", "t", "--at", "x=0,y=0,z=-0.45"}), 2);
  EXPECT_THAT(output_, HasSubstr("--at: is the reference pose of --urdf, --sdf or --mjcf, none of which is given"));
  EXPECT_EQ(run({"export", "study.h5", "--sdf", "c.sdf", "--at", "x=0,y=0,z=-4"}), 2);
  EXPECT_THAT(output_,
              HasSubstr("--sdf: mechanism rotary-delta has no model for simulation: its reference pose does not "
                        "assemble: "));
  EXPECT_FALSE(fs::exists(path("c.sdf")));
}

TEST_F(ExportProgram, OverwritesOnlyWithForce) {
  run_study();
  spill("best.vtkhdf", "mine");
  EXPECT_EQ(run({"export", "study.h5", "--vtk", "best.vtkhdf", "--csv", "t"}), 1);
  EXPECT_THAT(output_, HasSubstr("best.vtkhdf exists already; overwrite it with --force"));
  EXPECT_EQ(slurp("best.vtkhdf"), "mine");
  EXPECT_FALSE(fs::exists(path("t")));  // all output files are checked before the first one is written
  EXPECT_EQ(run({"export", "study.h5", "--vtk", "best.vtkhdf", "--csv", "t", "--force"}), 0) << output_;
  EXPECT_NE(slurp("best.vtkhdf"), "mine");
  EXPECT_EQ(run({"export", "study.h5", "--csv", "t"}), 1);
  EXPECT_THAT(output_, HasSubstr("t/evaluations.csv exists already"));
  ChildProcess::Settings small;
  small.file_size = 1000;
  EXPECT_EQ(run({"export", "study.h5", "--csv", "limited"}, small), 1);
  EXPECT_THAT(output_, HasSubstr("limited/evaluations.csv: cannot be written; any previous file is unchanged (File too "
                                 "large)"));
  EXPECT_TRUE(fs::is_empty(path("limited")));
  EXPECT_EQ(run({"export", "study.h5", "--csv", "study.toml"}), 1);
  EXPECT_THAT(output_, HasSubstr("study.toml"));
}

TEST_F(ExportProgram, FilesAreBitIdenticalForAnyThreads) {
  for (const char* const threads : {"1", "3"})
    ASSERT_EQ(run({"workspace", "quadrupteron", "--cells", "x=9,y=9,z=9", "--threads", threads, "--vtk",
                   std::string(threads) + ".vtkhdf", "--stl", threads}),
              0)
        << output_;
  EXPECT_EQ(slurp("1.vtkhdf"), slurp("3.vtkhdf"));
  EXPECT_EQ(slurp("1/quadrupteron-nominal.stl"), slurp("3/quadrupteron-nominal.stl"));
}

TEST_F(ExportProgram, HandlesDamagedEmptyUnfinishedAndUnreadableStudies) {
  run_study();
  std::string bytes = slurp("study.h5");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  spill("damaged.h5", bytes);
  EXPECT_EQ(run({"export", "damaged.h5", "--csv", "t"}), 1);
  EXPECT_THAT(output_, HasSubstr("damaged.h5: "));
  EXPECT_FALSE(fs::exists(path("t")));

  StudyContents study = read("study.h5");
  study.state = StudyState::running;
  study.final.reset();
  write_study(path("running.h5"), study);
  ASSERT_EQ(run({"export", "running.h5", "--csv", "running", "--stl", "running"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("the study is running: only the results recorded so far are exported\n"));
  EXPECT_EQ(lines("running/best.csv")[0], "kind,name,unit,best");

  study.toml = "[mechanism]\ntype = \"4ppa-2par\"\nforgotten = 1\n";
  study.text_digest.clear();  // as in files before schema 5
  write_study(path("old.h5"), study);
  EXPECT_EQ(run({"export", "old.h5", "--csv", "old"}), 0) << output_;  // tables do not need the study's problem
  EXPECT_THAT(output_, HasSubstr("note: old.h5: this program cannot read the study's text ("));
  EXPECT_EQ(run({"export", "old.h5", "--vtk", "old.vtkhdf"}), 2);
  EXPECT_THAT(output_, HasSubstr("forgotten"));

  study = read("study.h5");
  study.state = StudyState::interrupted;
  study.stages.clear();
  study.final.reset();
  study.best = {};
  write_study(path("empty.h5"), study);
  ASSERT_EQ(run({"export", "empty.h5", "--csv", "empty"}), 0) << output_;
  EXPECT_EQ(lines("empty/evaluations.csv").size(), 1u);
  EXPECT_FALSE(fs::exists(path("empty/best.csv")));
  EXPECT_EQ(run({"export", "empty.h5", "--vtk", "e.vtkhdf"}), 2);
  EXPECT_THAT(output_, HasSubstr("study study has no best design yet; expected an evaluated design"));
}

TEST_F(ExportProgram, AnEmptyWorkspaceHasNoSurface) {
  EXPECT_EQ(run({"workspace", "4ppa-2par", "--box", "x=2:3,z=-1:0,theta=0:1", "--stl", "."}), 1);
  EXPECT_THAT(output_, HasSubstr("the workspace has no surface: no cell is feasible"));
  ASSERT_EQ(run({"workspace", "4ppa-2par", "--box", "x=2:3,z=-1:0,theta=0:1", "--json"}), 0) << output_;
  EXPECT_EQ(Json::parse(output_)["feasible_cells"], 0);
  EXPECT_TRUE(Json::parse(output_)["axes"][0]["feasible"].is_null());
}

}  // namespace
}  // namespace pkm::testing

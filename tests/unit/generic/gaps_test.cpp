// Workspaces with gaps and dents that are narrower than a hundredth of them, or that no corner but one of another name
// shows: closed forms and files against each other. The volumes are those of files in 256 slices.
#include <gtest/gtest.h>

#include "tests/unit/accelerators/papers.hpp"

namespace pkm {
namespace {

struct Gap {
  const char *name, *mechanism;
  FixedCoordinate fixed;
  nlohmann::json design, limits;
  double volume;
};

const FixedCoordinate kMiddleOfY{1};

std::vector<Gap> gaps() {
  const auto x = [](double at) { return FixedCoordinate{0, FixedCoordinate::Kind::value, at}; };
  const nlohmann::json dented = {
      {"l_11", 0.10697920935258334},   {"l_12", 0.20148008027875641},  {"l_21", 0.35162414111788604},
      {"l_22", 0.28136329140348521},   {"l_31", 0.34466136518551566},  {"l_32", 0.12572349192155508},
      {"l_41", 0.26040116095360255},   {"l_42", 0.26124242117796898},  {"r", 0.057318197760931042},
      {"h", 0.024567422788774329},     {"l", 0.099486540826368458},    {"L", 0.26055376620421633},
      {"beta_1", 0.71484984500796367}, {"beta_2", 2.0390004157981716}, {"beta_3", 7.399871358889099},
      {"rho_max", 0.42395855515556191}};
  return {
      {"DentOf3CRR", "3crr-r-cru", x(0.19390092531555395), dented, {{"c_min", 0.26469031551584954}}, 0.22333850859},
      {"DentOfQuadrupteron",
       "quadrupteron",
       x(0.24400324144337049),
       dented,
       {{"c_min", 0.26469031551584954}},
       0.202960192663},
      {"DentBeyondACircle",
       "3crr-r-cru",
       x(0.22294195125651214),
       {{"l_11", 0.14879123571452751},
        {"l_12", 0.28717357028153395},
        {"l_21", 0.24645480812070922},
        {"l_22", 0.14156724145376612},
        {"l_31", 0.19247981176562576},
        {"l_32", 0.19095498332425825},
        {"l_41", 0.18916092705314988},
        {"l_42", 0.18976713056435798},
        {"r", 0.028702611638787606},
        {"h", 0.018713732466936025},
        {"l", 0.063758309759087639},
        {"L", 0.26441594475183461},
        {"beta_1", 0.94702272819170719},
        {"beta_2", 4.0717234689101778},
        {"beta_3", 6.2663479788218295},
        {"rho_max", 0.48599686237389633}},
       nlohmann::json::object(),
       0.272011402297},
      {"GapOfTheHybrid",
       "2t1r-p-hybrid",
       kMiddleOfY,
       {{"a", 0.12194450148094327},         {"b1", 0.18431012089466334},
        {"b2", 0.23433739571159659},        {"c", 0.13320436182122072},
        {"d", 0.21251364559107433},         {"e", 0.21184771555382528},
        {"L1", 0.31580373780424242},        {"L2", 0.19463687697327714},
        {"L3", 0.26911539023835307},        {"f", 0.12898072478662281},
        {"fp", 0.053286381728455762},       {"s_min_1", -0.17362347430201364},
        {"s_min_2", -0.14939847600071102},  {"s_min_3", -0.23205280254077462},
        {"s_min_4", -0.10311217084045089},  {"s_max_1", 0.18245200737989836},
        {"s_max_2", 0.20285959774803822},   {"s_max_3", 0.23704612287328272},
        {"s_max_4", 0.14781047586754364},   {"z_clear", 0.062238051410714285},
        {"beta_min", -0.70155926255558543}, {"beta_max", 0.57601064602671359},
        {"tau_s", 0.13831434603676218},     {"tau_p", 0.092943818315667198},
        {"tau_c", 0.044366111090280005},    {"psiA_max", 1.57},
        {"psiC_max", 1.2493281775226854},   {"lam_max", 0.57260636335595416},
        {"mu_max", 0.73666130748099012},    {"gap", 0.076870716823408611},
        {"phi_max", 0.64882043587245819},   {"lw_min", 0.13244121801449626},
        {"lw_max", 0.39047235694344484}},
       nlohmann::json::object(),
       0.00092375782116},
      {"CornersOfTheHybridThatChangeSurfaces",
       "2t1r-p-hybrid",
       kMiddleOfY,
       {{"a", 0.079210398587307468},       {"b1", 0.10129630552490163},       {"b2", 0.18740411821872116},
        {"c", 0.080823403909248012},       {"d", 0.20074397354588502},        {"e", 0.14089093791484625},
        {"L1", 0.26676920440035062},       {"L2", 0.28171789057929664},       {"L3", 0.27554349478920664},
        {"f", 0.082626556335832255},       {"fp", 0.068683487903216434},      {"s_min_1", -0.20435782015822926},
        {"s_min_2", -0.23100600429636647}, {"s_min_3", -0.16945741790968416}, {"s_min_4", -0.17842693950474484},
        {"s_max_1", 0.098872073263132756}, {"s_max_2", 0.25588095865034532},  {"s_max_3", 0.19905667701343194},
        {"s_max_4", 0.15655647100371825},  {"z_clear", 0.15319460054720357},  {"beta_min", -0.72090342981139233},
        {"beta_max", 0.90167764583976817}, {"tau_s", 0.096195958113691873},   {"tau_p", 0.17156156497023695},
        {"tau_c", 0.077734525553272052},   {"psiA_max", 1.1105206635538936},  {"psiC_max", 1.57},
        {"lam_max", 0.58197741770387423},  {"mu_max", 0.81412028100591682},   {"gap", 0.074617421971822695},
        {"phi_max", 0.59062680978631676},  {"lw_min", 0.13860095054214752},   {"lw_max", 0.20267016376424205}},
       nlohmann::json::object(),
       0.00215279598116},
      // here two conics touch where an upright side passes, and the section changes like a root beyond it
      {"BreaksSideBySide",
       "4ppa-2par",
       {1, FixedCoordinate::Kind::value, 1.2557407229134059},
       {{"a", 0.13172243428739475},
        {"b", 0.64117436921049209},
        {"l_u", 0.85895831248913201},
        {"l_d", 0.8399383995989409},
        {"d", 0.22644850690183313},
        {"L0", 2.1728137558370304}},
       nlohmann::json::object(),
       1.28949690112},
  };
}

void PrintTo(const Gap& gap, std::ostream* to) { *to << gap.name; }

class Gaps : public ::testing::TestWithParam<Gap> {};

TEST_P(Gaps, AreFoundWithTheirSlopes) {
  const Gap& gap = GetParam();
  const auto survey = [&](const Mechanism& mechanism) {
    const auto holds = [&](const Sweep& sweep) { return sweep.fixed.front() == gap.fixed.coordinate; };
    WorkspacePlan plan = test::columns(mechanism.info(), *std::ranges::find_if(mechanism.info().sweeps, holds));
    plan.fixed = {gap.fixed};
    plan.limits = test::limits_with(mechanism.info(), gap.limits);
    std::vector<Dual4> moving;
    const std::vector<double> design = test::design_with(mechanism.info(), gap.design);
    for (std::size_t i = 0; i < design.size(); ++i) {  // along directions of the names, whose order is not the same
      const std::string& name = mechanism.info().parameters[i].name;
      moving.emplace_back(design[i]);
      for (int k = 0; k < 4; ++k)
        moving.back().v[k] = design[i] * std::sin(1.0 + k * (name.front() + 3.0 * name.back()));
    }
    WorkspaceResult<Dual4> found;
    evaluate_once<Dual4>(*prepare_workspace(mechanism, plan, {}), moving, found);
    return found;
  };
  const WorkspaceResult<Dual4> file = survey(*test::described(gap.mechanism)),
                               own = survey(**std::ranges::find_if(
                                   all_mechanisms(), [&](const auto&m) { return m.name() == gap.mechanism; }));
  EXPECT_NEAR(file.volume.a / gap.volume, 1, 1e-9);
  EXPECT_NEAR(own.volume.a / gap.volume, 1, 1e-9);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(file.volume.v[k], own.volume.v[k], 1e-7 * (gap.volume + std::fabs(own.volume.v[k])));
}

INSTANTIATE_TEST_SUITE_P(All, Gaps, ::testing::ValuesIn(gaps()), [](const auto& gap) { return gap.param.name; });

}  // namespace
}  // namespace pkm

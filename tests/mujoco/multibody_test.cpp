// The MJCF files of mechanisms in MuJoCo: joint positions where the loops are closed, and drive forces that hold the
// mechanism against gravity and a wrench, compared with the inverse kinematics and the equations of motion.
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/export/multibody_files.hpp"
#include "tests/multibody/cases.hpp"

namespace pkm {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class MujocoModel {
 public:
  explicit MujocoModel(const std::string& mjcf) {
    const auto file = std::filesystem::path(testing::TempDir()) / "pkm_multibody_test.xml";
    std::ofstream(file) << mjcf;
    std::array<char, 1000> error{};
    model_ = mj_loadXML(file.c_str(), nullptr, error.data(), error.size());
    std::filesystem::remove(file);
    if (!model_) throw std::runtime_error(error.data());
    model_->opt.jacobian = mjJAC_DENSE;
    data_ = mj_makeData(model_);
    site_ = mj_name2id(model_, mjOBJ_SITE, "platform_frame");
  }
  ~MujocoModel() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  MujocoModel(const MujocoModel&) = delete;
  MujocoModel& operator=(const MujocoModel&) = delete;

  /// Moves the platform to a pose by Newton's method, with closed loops. @return the residual
  double assemble(const generic::RigidPose& target, bool with_orientation) {
    double residual = 1;
    for (int k = 0; k < 20 && residual > 1e-13; ++k) {
      mj_fwdPosition(model_, data_);
      const Index nv = model_->nv, sites = with_orientation ? 6 : 3;
      Index loops = 0;
      while (loops < data_->nefc && data_->efc_type[loops] == mjCNSTR_EQUALITY) ++loops;
      MatrixXd J(loops + sites, nv);
      VectorXd error(loops + sites);
      J.topRows(loops) = Eigen::Map<const RowMajor>(data_->efc_J, data_->nefc, nv).topRows(loops);
      error.head(loops) = Eigen::Map<const VectorXd>(data_->efc_pos, loops);
      RowMajor at_site(6, nv);
      mj_jacSite(model_, data_, at_site.data(), at_site.data() + 3 * nv, site_);
      J.bottomRows(sites) = at_site.topRows(sites);
      const Eigen::Matrix3d R = Eigen::Map<const RowMajor>(data_->site_xmat + 9 * site_, 3, 3);
      const Eigen::AngleAxisd turned(R * target.rotation.transpose());
      error.segment<3>(loops) = Eigen::Map<const Vector3d>(data_->site_xpos + 3 * site_) - target.origin;
      if (with_orientation) error.tail<3>() = turned.angle() * turned.axis();
      residual = error.lpNorm<Eigen::Infinity>();
      const VectorXd step = -Eigen::CompleteOrthogonalDecomposition<MatrixXd>(J).solve(error);
      mj_integratePos(model_, data_->qpos, step.data(), 1);
    }
    return residual;
  }

  /// Returns to the reference pose, at rest.
  void reset() { mj_resetData(model_, data_); }

  int drives() const { return model_->nu; }
  double drive_position(int i) const { return positions()[i]; }
  const char* drive_name(int i) const { return mj_id2name(model_, mjOBJ_ACTUATOR, i); }

  /// Simulates until the mechanism is at rest, with its drives held in place by a controller: the soft constraints
  /// yield until they balance the loads. @return the forces of the motors
  /// @param wrench  force and moment on the platform at a point
  VectorXd holding_forces(const Wrench<double>& wrench, const Vector3d& point) {
    constexpr int kSteps = 200;
    constexpr double kForce = 10, kFrequency = 300;  // [N, N m; rad/s]
    const int platform = model_->site_bodyid[site_];
    const Vector3d centre = Eigen::Map<const Vector3d>(data_->xipos + 3 * platform), force(wrench.m.data());
    Eigen::Map<Vector3d>(data_->xfrc_applied + 6 * platform) = force;
    Eigen::Map<Vector3d>(data_->xfrc_applied + 6 * platform + 3) =
        Vector3d(wrench.m.data() + 3) + (point - centre).cross(force);
    mju_zero(data_->qvel, model_->nv);
    mju_zero(data_->qacc_warmstart, model_->nv);
    const VectorXd start = positions(), free = accelerations(VectorXd::Zero(drives()));
    MatrixXd by_force(drives(), drives());
    for (Index i = 0; i < drives(); ++i)
      by_force.col(i) = (accelerations(VectorXd::Unit(drives(), i) * kForce) - free) / kForce;
    const auto mass = by_force.partialPivLu();
    VectorXd forces;
    for (int step = 0; step < kSteps; ++step) {
      forces = mass.solve(-free - kFrequency * (2 * speeds() + kFrequency * (positions() - start)));
      std::ranges::copy(forces, data_->ctrl);
      mj_step(model_, data_);
    }
    EXPECT_LE(speeds().lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_LE((positions() - start).lpNorm<Eigen::Infinity>(), 1e-4);
    return forces;
  }

 private:
  VectorXd accelerations(const VectorXd& forces) {
    std::ranges::copy(forces, data_->ctrl);
    mj_forward(model_, data_);
    return of_drives(data_->qacc, model_->jnt_dofadr);
  }
  VectorXd positions() const { return of_drives(data_->qpos, model_->jnt_qposadr); }
  VectorXd speeds() const { return of_drives(data_->qvel, model_->jnt_dofadr); }
  VectorXd of_drives(const mjtNum* values, const int* address) const {
    VectorXd found(drives());
    for (int i = 0; i < drives(); ++i) found[i] = values[address[model_->actuator_trnid[2 * i]]];
    return found;
  }

  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  int site_ = -1;
};

class MujocoMultibody : public testing::TestWithParam<test::MultibodyCase> {};

TEST_P(MujocoMultibody, FindsJointPositionsAndHoldingForces) {
  const auto& [name, has_orientation] = GetParam();
  const test::NominalDesign mechanism(name);
  MujocoModel mujoco(mjcf_text(mechanism.model(), name));
  ASSERT_EQ(mujoco.drives(), static_cast<int>(mechanism.info().joints.size()));
  const std::vector<Pose<double>> poses = mechanism.poses(20);
  ASSERT_EQ(poses.size(), 20U);
  Stream random(31, 0, 0, Stream::Use::start);
  for (const Pose<double>& pose : poses) {
    double residual = 1;
    mujoco.reset();
    for (const double fraction : {0.0, 0.25, 0.5, 0.75, 1.0})
      residual = mujoco.assemble(mechanism.platform(mechanism.between(pose, fraction)), has_orientation);
    ASSERT_LE(residual, 1e-12);
    const AxisVector<double> joints = *mechanism.inspect(pose).joints;
    Wrench<double> wrench;
    for (std::size_t i = 0; i < (has_orientation ? 6U : 3U); ++i) wrench[i] = (i < 3 ? 50 : 5) * (2 * random.u01() - 1);
    const AxisVector<double> zero(pose.size()), ours = mechanism.forces({pose, zero}, zero, wrench);
    std::vector<double> positions;
    for (int i = 0; i < mujoco.drives(); ++i) positions.push_back(mujoco.drive_position(i));
    const VectorXd theirs = mujoco.holding_forces(wrench, mechanism.wrench_point(pose));
    const double largest = theirs.lpNorm<Eigen::Infinity>();
    EXPECT_GT(largest, 1);
    for (int i = 0; i < mujoco.drives(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_EQ(mujoco.drive_name(i), mechanism.info().joints[k].name);
      const double error = positions[k] - joints[k];
      EXPECT_NEAR(mechanism.info().joints[k].turns() ? std::remainder(error, 2 * kPi) : error, 0, 1e-6);
      EXPECT_NEAR(theirs[i], ours[k], 1e-3 * largest);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, MujocoMultibody, testing::ValuesIn(test::multibody_cases()), test::name_of_case);

}  // namespace
}  // namespace pkm

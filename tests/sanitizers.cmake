# What the address sanitizer leaves to the release build, so that a test run stays within half an hour: tests of numbers,
# whose formulas the contracts, the command line and the fuzzers evaluate, too; comparisons of many designs; repetitions
# over mechanisms, interruptions and words of messages that lead through the same code. Watched and unoptimised, tests
# take some twenty times as long.
set(PKM_FILES_OF_RELEASE
  "unit/(accelerators|dynamics|geometry|mechanism)/.*"
  contracts/same_bits_contract contracts/derivative_contract contracts/workspace_fields_contract contracts/influence_contract
  "generic/(bounded_columns|bounds|contracted_box|corner_curves_volume|drive_trains|dynamics|edge_plan|elasticity)"
  "generic/(fastest_motion|forward|gaps|multibody_model|orientations|outer_quadrature|performance|performance_numeric)"
  "generic/(reactions|reactions_along|references|rod_loads|sample_nodes|sample_slopes|slivers|transmission)"
  "config/(choices|constraint_singular_value|fastest_study|limb_joints|limb_variables|mechanism_chains|mechanism_robots)"
  "config/(mobility|motion_parameters|motion_speeds|orientation_objective|region|size_objectives|solved_chains|tolerance)"
  "problem/(diagnosis|expression|formula_quantity)" "runner/(probe|solver_study)"
  "workspace/(components|home_columns|pose_quantity)" workspace/bounds/force_balance storage/h5py
  "cli/(changed_study|command_line|compare|completion|corrupted_file|crr_cru|diagnosis|expression|extension|generate)"
  "cli/(golden|hybrid|largest_solid|mechanism_file_study|messages|next_step|outputs|pareto_front|quantity|report)"
  "cli/(sensitivity|solver_study|stop|table_input|tool_error)")
set(PKM_TESTS_OF_RELEASE
  FindsTheFront ResumedAt ForwardInvertsInverse IsBitIdentical/ipopt NoDesignDominates SurfacesOfAny
  IsExportedWithinItsBox HasAnyByteDamaged DesignLevelConstraintsAreSatisfied VoxelsAgreeWithColumns
  NoPoseIsFeasibleOutsideTheReach AreReportedAndExported/Version VoxelAnalysisEqualsTestingEveryCell GoldenStatistics
  EveryArchivedDesign ScalingAllLengthsScalesTheVolumeByTheExponentOfItsUnit/file
  ExpressionNamesAreDistinctAndHaveTheRightValues/file OfCranksAreExactToo OfAnyFormulasAreThose CliSlice.BoxWithin
  CliSlice.SliceAreas CliSlice.PlanarWorkspace CliSlice.PictureHas OutlineAreaEqualsCellCount ProofsAreAccepted
  OneTwoAndSevenThreads ClaimDesignsDynamically Ranks.StopTogether Ranks.WarnOfMore Ranks.RunSeeds Ranks.AreReported
  Ranks.RunOther Ranks.EndTogether Ranks.AreNamedIfTheirResults MechanismFile.Forward MechanismFile.PoseNames
  MechanismFile.WithAnUnknown MechanismFile.AStudyRefers MechanismFile.ANewStudy GivesTheSameFile GiveTheSameFile
  Bounds.AreTheSame GenericColumns.AreTheExactOnes SampleInsideTheWorkspace IsTheLeastDistanceOf
  Portable.ErrorsStayWithin GenericColumns.AreTheGoldenVolumes HaveTheGoldenDerivatives Bounds.OfABall
  LimbParameter.DefaultsTo MechanismFile.AStudyResumes MechanismFile.Replaces /quadrupteron /file_gough
  /file_linear_delta ResumingAfterAnyGeneration VoxelsConvergeToTheColumns InactiveLimitsLie
  LargePopulationsAreBitIdentical ReportsTheDistanceToAGivenFront SolvesActiveConstraintsFromEverySeed
  FunctionsAgreeWithTheMath JacobianEqualsFiniteDifferencesOfTheJoints AnyDesignOfAStudyCanBeSelected
  Certify.BoundsVolumes AFullDiskIsAnError BoxKeepsRanges SeedsAreRepeated VtkAndCsvOfAny SlowSteps RandomSlopes
  RecordedStudy.Changed UndefinedValues ConcurrentStartsAreBitIdentical IpoptSolvesInSeveral Ranks.RunIpopt
  Obstacle.BestDesignOfTheExample DifferentSeedsGiveDifferentDesigns/ipopt UndefinedConditioning CliJointForces
  MechanismFile.WhoseColumns MechanismFile.InvalidFiles LimbParameter.UnknownNames IsNotOverwrittenByOutputs
  OverwritesOnlyWithForce ExistingFilesAreNotOverwritten NewFilesAreShort Obstacle.InvalidDefinitions
  TooManyCellsAreRejected ADeviationFromTheRecord LongLinesTakeNoTime AHigherEvaluationLimitResumes
  ThreadsDoNotMatter/ipopt AgreeWithDenseSlices OfRandomSolidsIs AlongTheOutermostCoordinateAre EachFieldHasItsOwnMap
  BoundsHoldTheExactVolumesOfTheBuiltIn MapShowsAFieldWithUnit OnlyTheFirstMotionsAreEmbedded
  SaysWhetherItsVolumeDepends HasTheAccuracyForJointErrors CallsLeaveNoMemoryBehind
  GivesTheRatesOfTheJointsInEveryMode MotionConstraint.AgreesWith VoxelsAgreeWithPoseReports
  VoxelsAreThePosesThatAreClear ClausesAreEquivalentToTheConstraint ResumingNeedsTheSameFile SingleDesignHasWorkspace
  PoseLevelConstraintsOnlyReduce ColumnsAreClippedByABoxOrRejectIt/2t1r LineWrapping ResultIsPrintedBeforeAWriteError
  MarginsHaveDerivatives EdgeVolumeGradient ExpressionNamesAreDistinctAndHaveTheRightValues/3crr
  ExpressionNamesAreDistinctAndHaveTheRightValues/2t1r HaveTheDerivativesOfDifferences
  FinalDesignsAreCertifiedBetween ProvenVolume.Of ObjectiveContract.IsDefinedOrExplained RunStudy.OutOfMemory
  CliTrajectory.FastestMotion ExportProgram.ModelsForSimulation DrawsTheExactError CliTrajectory.ReadsTheTable
  CertifiedTolerances.OfMechanismFiles PoseBox.OnlyTheBalls Tolerances.OfFree Connect.HomePoseSelectsOneSide
  NanIsFailedAndNeverBest/ipopt RespectsBounds/ipopt OfTenThousandPoses PublishedPosesAndSlices
  MarginsHaveTheSameNames OfFewBoxesAreCertified /Version5 /Version6 /Version7 Cables.CertifiedBoxes /file_cables
  /file_chains /file_frames OldStudies.AreShown OldStudiesOfOtherVersions Formula.RandomText ExportProgram.AnEmpty
  ExportProgram.Handles ExportProgram.Workspace ExportProgram.WritesTables TheSixLegsOfAGough Obstacles.AreRefused
  PageData.DeltaHas CertifiedVolumes.ArePrinted CliSlice.Fixing LiveProgram.Interrupted PageData.MotorQuantities
  PageData.DrivesHave PageData.MotionsInclude Obstacle.Reduces Solve.Integrates Certify.Tampered FieldsOfAFineGrid
  Obstacles.AreNamed DeviationBox.IsCertified CliEvaluate.UsesTheBaseline RecordedStudy.Unchanged
  ThreadsCanShareAFormula ObjectivesAndConstraintsAlongAMotion NumberOfThreadsFromEnvironment)  # Clang's OpenMP does not survive some of its numbers

# pkm_leave_to_release(SOURCES): takes such files out of a list of sources.
function(pkm_leave_to_release sources)
  if(PKM_SANITIZE MATCHES "address")
    foreach(files IN LISTS PKM_FILES_OF_RELEASE)
      list(FILTER ${sources} EXCLUDE REGEX "/${files}_test\\.cpp$")
    endforeach()
    set(${sources} ${${sources}} PARENT_SCOPE)
  endif()
endfunction()

set(PKM_GTEST_FILTER "*")
if(PKM_SANITIZE MATCHES "address")
  list(TRANSFORM PKM_TESTS_OF_RELEASE REPLACE "(.+)" "*\\1*")
  list(JOIN PKM_TESTS_OF_RELEASE ":" PKM_GTEST_FILTER)
  string(PREPEND PKM_GTEST_FILTER "-")
endif()

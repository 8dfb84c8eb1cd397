# What the address sanitizer leaves to the release build, so that a test run stays within half an hour: comparisons of
# many designs, and repetitions over mechanisms, interruptions and words of messages that lead through the same code.
# Watched and unoptimised, they take some twenty times as long.
set(PKM_FILES_OF_RELEASE
  contracts/same_bits_contract contracts/derivative_contract contracts/workspace_fields_contract crr_cru/derivatives
  cli/generate cli/table_input generic/bounded_columns accelerators/agreement accelerators/golden_grids generic/sample_slopes
  four_ppa_two_par/derivatives hybrid/breaks storage/h5py cli/changed_study cli/crr_cru cli/mechanism_file_study
  cli/expression cli/extension cli/golden cli/hybrid cli/messages cli/next_step cli/corrupted_file cli/outputs
  cli/sensitivity cli/stop cli/tool_error cli/diagnosis)
set(PKM_TESTS_OF_RELEASE
  CrrCruColumns CountsFromRows ColumnsAgree NoPoseIsNearer TakenApart VirtualWorkIsNewtonEuler
  DerivativesOfTheSmoothPeak IsEstimatedHonestly ALargerClearance DerivativesOfStatistics DerivativesOfMeans
  VoxelsConvergeToColumns EqualsNumericalSearch FindsTheFront EndsTheSame EndTheSame ResumedAt
  ThreadsAndExtensionsDoNotMatter SeedsAreComparedBy RefinedPointsDominate ShowsFrontsAndEvaluates OfTheClearPoses
  SumOverPlanes SumOfTheirColumns ForwardInvertsInverse IntegratedOverY DerivativesOfTheVolume IsBitIdentical/ipopt
  NoDesignDominates ForwardAfterInverse SurfacesOfAny IsExportedWithinItsBox HasAnyByteDamaged
  ListsAllEntriesOfTheCatalogues DesignLevelConstraintsAreSatisfied VoxelsEqualThePlainLoop
  DerivativesEqualThoseOfTheEquivalent StrewnOverTheLinks CtrlCStopsInsideASolver RefusesPointsThatDoNotExist
  VoxelsAgreeWithColumns NoPoseIsFeasibleOutsideTheReach AreReportedAndExported/Version BothSolversAgreeOnTheOptimum
  OfInertiaInVoxelsAndColumnsWithDerivatives AreasOverYHaveNoKink ToleranceIsKept ExactVolumesWithinWhat
  ForwardKinematicsFindThePose VoxelAnalysisEqualsTestingEveryCell OfXHoldThePoses EveryAssemblyHasTheDrives
  GoldenStatistics EveryArchivedDesign SensitivitiesEqualFiniteDifferences VoxelsConvergeToThem EqualsAFineMidpointSum
  CountsFromColumnsEqual PowerOfTheDrives ScalingAllLengthsScalesTheVolumeByTheExponentOfItsUnit/file
  HoldReferenceVolumesOfFiles HoldWhatVoxelsCountAlmost TouchAllAlong
  ExpressionNamesAreDistinctAndHaveTheRightValues/file OfCranksAreExactToo OfAnyFormulasAreThose CliSlice.BoxWithin
  CliSlice.SliceAreas CliSlice.PlanarWorkspace CliSlice.PictureHas EveryStudyPassesItsCheck OutlineAreaEqualsCellCount
  ProofsAreAccepted ReportProgram.IsTheSameOnAny TheEstimateCounts ATimeLimitStopsEarly AFinishedStudyGetsMore
  StartsFromDistinctBasins OneTwoAndSevenThreads SolverProgram.ThreadsDoNotMatter ClaimDesignsDynamically
  GivesTheSameFile GiveTheSameFile RigorousBounds.AreTheSame RigorousBounds.HoldVolumes GenericColumns.AreTheExactOnes
  SampleInsideTheWorkspace IsTheLeastDistanceOf Portable.ErrorsStayWithin GenericColumns.AreTheGoldenVolumes
  HaveTheGoldenDerivatives RigorousBounds.OfABall RigorousBounds.OfMotions SurveysTheInertiaThatItsEquations
  StatesOfARowHaveTheBitsOfOneByOne/gough BoxDistance.IsThePenetrationDepth LimbParameter.DefaultsTo
  MechanismFile.AStudyResumes MechanismFile.Replaces IsNullWithoutGoodCells ResumedGiveTheResultOf /quadrupteron
  /file_gough /file_3crr_r_cru /file_linear_delta ResumingAfterAnyGeneration VoxelsConvergeToTheColumns
  InactiveLimitsLie SignalsStopWithACheckpoint TheirDrivesAreThoseOfVirtualWork LargePopulationsAreBitIdentical
  EqualsDistanceToEdges ReportsTheDistanceToAGivenFront SolvesActiveConstraintsFromEverySeed FunctionsAgreeWithTheMath
  CentrifugalForces SlidersAloneAreABound PositionSetsAndInspectionAgree JacobianEqualsFiniteDifferencesOfTheJoints
  CoriolisMatricesGive ClearanceTestAgreesWithMinimum KineticEnergyGrows AnyDesignOfAStudyCanBeSelected
  Certify.BoundsVolumes LookAsFarAsGiven HaveOthersBesideThem IsNamedAfterTheStudy AFullDiskIsAnError BoxKeepsRanges
  SeedsAreRepeated EveryMotionIsFeasible VtkAndCsvOfAny InstructionSetIsSelected CliHelp CliExamples
  TheLargestIsThatOfSingleStates Completion SlowSteps RandomSlopes RecordedStudy.Changed UndefinedValues
  ConcurrentStartsAreBitIdentical IpoptSolvesInSeveral Ranks.RunIpopt Obstacle.BestDesignOfTheExample
  PoseAndForwardOfGolden DifferentSeedsGiveDifferentDesigns/ipopt CliErrors UndefinedConditioning CliJointForces
  MechanismFile.WhoseColumns MechanismFile.InvalidFiles LimbParameter.UnknownNames IsNotOverwrittenByOutputs OverwritesOnlyWithForce
  ExistingFilesAreNotOverwritten NewFilesAreShort Obstacle.InvalidDefinitions CheckReportsIncompatibleSettings
  TooManyCellsAreRejected ADeviationFromTheRecord LongLinesTakeNoTime AHigherEvaluationLimitResumes ThreadsDoNotMatter/ipopt
  ExampleFindsTheLargestWorkspace OfRandomDesignsAreThoseOfSlices OfLimitsOfTwoCoordinates AgreeWithDenseSlices
  OfRandomSolidsIs HaveDerivativesThatAgreeWithDifferences/rotarydelta ExampleOfAccuracyReaches ExampleOfStiffnessEnds
  ExampleOfTransmissionImproves Performance.HasDerivatives AlongTheOutermostCoordinateAre EachFieldHasItsOwnMap
  LimitsAreThresholdsOfTheCommandLine BoundsHoldTheExactVolumesOfTheBuiltIn MapShowsAFieldWithUnit
  HybridVoxels.CountsAndIndices Quantity.IsAFieldOfTheWorkspace Quantity.IsPrintedWith RecognisesPlanesSpheres
  OnlyTheFirstMotionsAreEmbedded SaysWhetherItsVolumeDepends HasTheAccuracyForJointErrors FromInertiaInVoxels
  CallsLeaveNoMemoryBehind
  NanIsFailedAndNeverBest/ipopt RespectsBounds/ipopt CatalogueMdIsUpToDate NumberOfThreadsFromEnvironment)  # Clang's OpenMP does not survive some of its numbers

# pkm_leave_to_release(SOURCES): takes such files out of a list of sources.
function(pkm_leave_to_release sources)
  if(PKM_SANITIZE MATCHES "address")
    list(JOIN PKM_FILES_OF_RELEASE "|" files)
    list(FILTER ${sources} EXCLUDE REGEX "/(${files})_test\\.cpp$")
    set(${sources} ${${sources}} PARENT_SCOPE)
  endif()
endfunction()

set(PKM_GTEST_FILTER "*")
if(PKM_SANITIZE MATCHES "address")
  list(TRANSFORM PKM_TESTS_OF_RELEASE REPLACE "(.+)" "*\\1*")
  list(JOIN PKM_TESTS_OF_RELEASE ":" PKM_GTEST_FILTER)
  string(PREPEND PKM_GTEST_FILTER "-")
endif()

# What the address sanitizer leaves to the release build, so that a test run stays within half an hour: comparisons of
# many designs, and repetitions over mechanisms, interruptions and words of messages that lead through the same code.
# Watched and unoptimised, they take some twenty times as long.
set(PKM_FILES_OF_RELEASE contracts/same_bits_contract contracts/slope_contract contracts/workspace_fields_contract
  crr_cru/derivatives described/bounded_columns described/closed_forms described/sample_slopes four_ppa_two_par/slopes
  hybrid/breaks storage/h5py
  cli/changed_study cli/crr_cru cli/described_study cli/expression cli/extension cli/golden cli/hybrid cli/messages
  cli/next_step cli/noise cli/outputs cli/sensitivity cli/stop cli/tool_error cli/verdict)
set(PKM_TESTS_OF_RELEASE
  CrrCruColumns CountsFromRows ColumnsAgree NoPoseIsNearer TakenApart VirtualWorkIsNewtonEuler SlopesOfTheStandIn
  IsEstimatedHonestly ALargerClearance DerivativesOfStatistics DerivativesOfMeans VoxelsConvergeToColumns
  EqualsASearch FindsTheFront EndsTheSame EndTheSame ResumedAt ThreadsAndExtensionsDoNotMatter SeedsAreComparedBy
  RefinedPointsDominate ShowsFrontsAndEvaluates OfTheClearPoses SumOverPlanes SumOfTheirColumns ForwardInvertsInverse
  IntegratedOverY SlopesEqualDifferences StraightThrough/ipopt NoDesignDominates ForwardAfterInverse SurfacesOfAny
  IsPicturedInItsBox EveryDamagedByte NamesEverythingInTheCatalogues DesignLevelOnesHold VoxelsEqualThePlainLoop
  SlopesEqualThoseOfTheEntry StrewnOverTheLinks CtrlCStopsInsideASolver RefusesPointsThatAreNotThere
  VoxelsAgreeWithColumns NoPoseIsFeasibleOutOfItsReach AreReportedAndExported/Version
  BothSolversAgreeOnTheOptimum OfInertiaInVoxelsAndColumnsWithDerivatives AreasOverYHaveNoKink ToleranceIsKept
  ExactVolumesWithinWhat AgreesOnRandomPoses ForwardKinematicsFindThePose HasTheSameCellsOnEvery
  SurveysOfVoxelsAreThoseOf OfXHoldThePoses EveryAssemblyHasTheDrives GoldenStatistics EveryArchivedDesign
  SensitivitiesForesee VoxelsConvergeToThem EqualsAFineMidpointSum CountsFromColumnsEqual HasTheSameExactVolumes
  PowerOfTheDrives ScalingAllLengthsScalesTheVolumeAsItsUnitSays/file HoldReferenceVolumesOfFiles
  HoldWhatVoxelsCountAlmost TouchAllAlong HasTheSameCouplingOverEvery ExpressionsKnowItsNumbersByDistinctNames/file
  OfCranksAreExactToo OfAnyFormulasAreThose HasTheSameSlopesOfSamples HasTheSameCellsUnderAClearance CliSection.A
  CliSection.ThePicture EveryStudyPassesItsCheck TheOutlineGoesAround ProofsAreAccepted
  ReportProgram.IsTheSameOnAny TheEstimateCounts ATimeLimitStopsEarly AFinishedStudyGetsMore StartsFromDistinctBasins
  OneTwoAndSevenThreads SolverProgram.ThreadsDoNotMatter ClaimDesignsInTurn CertainBounds.AreTheSame
  CertainBounds.HoldVolumes DescribedColumns.AreTheExactOnes SampleInsideTheWorkspace IsTheLeastDistanceOf
  Portable.ErrorsStayWithin DescribedColumns.AreTheGoldenVolumes HaveTheGoldenDerivatives CertainBounds.OfABall
  CertainBounds.OfMotions SurveysTheInertiaThatItsEquations StatesOfARowHaveTheBitsOfOneByOne/gough
  IsTheShortestWayOut LimbParameter.OfAStudyIs MechanismFile.AStudyGoesOn MechanismFile.StandsFor
  WhatHasNoneOrCannotHaveOne EndAsTheirOwnProgramEnded /quadrupteron /file_gough /file_3crr_r_cru /file_linear_delta
  StoppedAnywhereAndResumed VoxelsConvergeToTheColumns InactiveLimitsLie SignalsStopWithACheckpoint
  TheirDrivesAreThoseOfVirtualWork ALargePopulationByATeam IsThatOfEndsAndEdges ReportsTheDistanceToAFront
  SolvesActiveConstraintsFromEverySeed FunctionsAreThoseOfTheMaths CentrifugalForces SlidersAloneAreABound
  FramesAndInspectionAgree ThoseOfThePapersMechanismsAre JacobianEqualsDifferencesOfTheJoints CoriolisMatricesGive
  KeepsClearWhereNothingIsNearer KineticEnergyGrows AnyDesignOfAStudyCanBeNamed Certify.BoundsVolumes
  LookAsFarAsGiven HaveOthersBesideThem
  IsCalledLikeTheStudy AFullDiskIsAnError RangesThatABoxDoesNotName SeedsAreRepeated EveryMotionIsFollowed
  VtkAndTheTableOfAny AnInstructionSetIsChosen CliHelp CliExamples TheLargestIsThatOfSingleStates Completion
  SlowSteps RandomSlopes RecordedStudy.Changed UndefinedValues
  SideBySideIsTheSame IpoptSolvesInSeveral Ranks.RunIpopt Obstacle.OfTheExample PoseAndForwardOfGolden
  AnotherSeedSearchesElsewhere/ipopt SameSeedSameBits/ipopt
  CliErrors UndefinedConditioning CliJointForces WhatIsNoneIsRefused ThatIsNoneIsRefused NoOutputOverwritesIt
  OverwritesOnlyWhenTold ExistingFilesAreNotOverwritten AFileToBeginWith IsRefusedInASentence CheckNamesBothSides
  MoreCellsThanAFile ALeftPathBegins AHigherLimitGoesOn ThreadsDoNotMatter/ipopt NanIsFailedAndNeverBest/ipopt
  KeepsBounds/ipopt CatalogueInTheExperiments
  ThreadsAreAsManyAsOpenMPIsTold)  # Clang's OpenMP does not survive some of its numbers

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

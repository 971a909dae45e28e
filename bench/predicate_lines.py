# SPDX-License-Identifier: Apache-2.0
"""Makes the table of docs/predicates.md from lines that tests of maps_test print, claim by claim. Uses only Python's
standard library."""

import re
import subprocess

from measured_tables import Table

# Claim, the test that checks it, and a pattern of the lines to show (empty: all lines).
CLAIMS = (
    ("I2", "SoftShadowMap.AtATexelOfTheReceiversItIsBackproject", ""),
    ("I7", "MapsBitmask.NothingVisibleIsHiddenByQuadsAndTrianglesOfAConvexBody", ""),
    ("I14", "MapsContourClaims.AGapThatTheCentreDoesNotSeeIsNotThere", ""),
    ("I15", "MapsPredicates.BehindAConvexBodyPeelingIsTheSecondPass", ""),
    ("I18", "MapsFusion.SumsAreSumsAndUnionsUnions", ""),
    ("I22", "DeepPenumbra.CompressedStepsStayWithinTheBoundEverywhere", ""),
    ("I23", "SliceMethods.OneFlatBlockerIsExactWithinHalfATexel", ""),
    ("T1", "MapsBackproject.IsWithinATexelOfTheAreaUnderAParallelSquare", ""),
    ("T8", "SliceMethods.TwoBlockersAreMultipliedInEveryLayout", ""),
    ("T11, F6", "Vssm.TheWorstLeakUnderTwoSheetsIsTheClosedForm", r"form [\d.]+$"),
    ("B4", "MapsBitmask.BarsThinnerThanATexelAreLostToQuadsAndNotToPatches", ""),
    ("N7", "SoftShadowMap.SixteenBitSumsStopAsTheKernelGrows", ""),
    ("A1, A2, A7", "MapsPeel.TheSecondLayerClosesTheGapUnderASquare", ""),
    ("A3, A6", "MapsPeel.FillClosesASpheresGapsAndShadesTooMuchTheMoreTheFiner", "^(sphere|edges|diagonal)"),
    ("A4, A8", "MapsPeel.AnObliqueSheetLeaksThroughDiagonals", ""),
    ("A8", "MapsFusion.ADeepPatchThatIsHalfOnTheLightHidesTheOneBeforeIt", ""),
    ("A9", "MapsPeel.MidpointsRemoveAcneOfClosedSolids", ""),
    ("A12", "MapsPeel.TheBiasTradesAcneForLeaks", ""),
    ("A15", "ABoxOverAFloor.SidesThatTheCentreDoesNotSeeHideALargeLight", "bias"),
    ("A16", "MapsPeel.BoundingSpheresCoverHalfPiAsMuch", ""),
    ("A16", "SphereForm.AHalfPlaneHidesASegmentTimesHalfPi", ""),
    ("B2", "MapsPredicates.TheNotesPatternHasThirtyThreeLevelsUnderAnAlignedEdge", ""),
    ("B5", "MapsPredicates.TrianglesLoseLessThanQuads", ""),
    ("B6", "MapsPredicates.QuadsOfATiltedPlaneDoNotLeakAsPatchesDo", ""),
    ("B7", "MapsPredicates.QuadsHaveLessAcneThanPatches", ""),
    ("B8", "MapsPredicates.LayersAskAsManyTimesAsMuch", ""),
    ("B9, B10", "MapsBitmask.LevelsFattenPatchesAndBoxesLess", ""),
    ("B11", "MapsBitmask.BlendedLevelsHaveSmallerSteps", ""),
    ("B13", "MapsSubsampled.TheErrorGrowsWithTheStep", ""),
    ("B13", "MapsSubsampled.PixelsAreLeftOutWherePenumbraeAreWide", ""),
    ("B14", "MapsBackproject.ALevelIsTheSumOfItsBlocks", ""),
    ("H1", "MapsHorizon.WhatIsHiddenIsTakenFromWhatIsAbove", r"^(backproject|contour|bitmask|packet:sublights=2) "),
    ("S1′", "MapsPredicates.LayersOfNestedShellsBringTheShadowBack", ""),
    ("C1", "MapsContourClaims.NoLightLeaksThroughJoinedSurfaces", ""),
    ("C3", "MapsPredicates.OutlinesJumpWhereDepthsAtThemDo", ""),
    ("C4, C6", "MapsContourClaims.HierarchiesLookAtFewerCells", ""),
    ("C7", "MapsContourClaims.PacketsAreMoreCoherentUnderLargerLights", ""),
    ("C8", "MapsContourClaims.SubLightsLookAtAsManyTexels", ""),
    ("M1, M3", "MapsContourClaims.SubLightsBreakTheFloorOfOneView", ""),
    ("M1", "MapsContour.SubLightsOfAnyShape", ""),
    ("M4", "MapsPredicates.NarrowPenumbraeStayAliasedUnderSubLights", ""),
    ("E1, E5", "SoftShadowMap.TheErrorStopsFallingWithResolutionAndGrowsTowardTheLight", ""),
    ("E2", "SoftShadowMap.AParallelRectangleIsOffByNoMoreThanItsTexels", ""),
    ("E3, E4, E12", "SoftShadowMap.TwoPassesAreDarkerEverywhereAndNearerToTheTruthForSolids", ""),
    ("E6", "ABoxOverAFloor.FartherAsideTooFull", "error"),
    ("E6", "ABoxOverAFloor.UnderTheLightIsNearerToTheTruthThanAside", "0.4 aside: error"),
    ("E7", "SoftShadowMap.LargeLightsDoWithSmallMaps", ""),
    ("E9", "MapsPredicates.OverATiltedPlaneSumsAreLessBiasedThanUnions", ""),
    ("E10", "SoftShadowMap.ATurnedSquareIsNearerToTheTruthThanTheWorstAlignedOne", ""),
    ("E11", "MapsPredicates.PenumbraeReachInwardAndOutwardAsFarAsTheyDo", ""),
    ("E12", "MapsSingleShadow.OuterPenumbraeOverestimateTheUmbraAndInnerOnesLoseIt", ""),
    ("N1", "SoftShadowMap.TwoPassesOverAThinSolidCostTwice", ""),
    ("F4", "Filters.BlockersBesideTheLightDarkenWhatTheyDoNotShade", ""),
    ("F4", "Filters.BlockersAtTwoHeightsLightTheUmbra", ""),
    ("F5", "Filters.FewTapsAreFarFromMany", ""),
    ("F7", "Vssm.MoreTermsOfTheSeriesComeCloserToCounting", ""),
    ("F8", "Vssm.TheExponentialFailsWhereTexelsLieBehindTheReceiver", ""),
    ("D1", "AdaptiveLight.MapsGrowWithThePenumbraAndAreFewForSmallLights", ""),
    ("D2, D6", "AdaptiveLight.FromFarAwayOnlyTheLightsOwnViewRefines", ""),
    ("D4", "AdaptiveLight.CornersAreNotTheLightsMean", ""),
    ("L1", "LayeredAttenuation.EpsilonTradesSpeckleOnCurvedSurfacesForLeaksAtContact", ""),
    ("O3", "SliceMethods.ConvolutionFailsWithTheBlockersExtentInDepth", ""),
)


def lines_of(output):
    """Returns the lines that each test prints, without repetitions and claims' names, and with single spaces."""
    printed, test = {}, None
    for line in output.splitlines():
        if begun := re.match(r"\[ RUN      \] (\S+)", line):
            test = begun[1]
        elif line.startswith("[  "):
            test = None
        elif test is not None and line.strip():
            text = re.sub(r"\b[A-Z]\d+'?:? ", "", " ".join(line.split()), count=1)
            printed.setdefault(test, {})[text] = None
    return printed


def rows(bench):
    names = [test for _, test, _ in CLAIMS]
    program = bench.program_path.with_name("maps_test")
    output = subprocess.run([program, f"--gtest_filter={':'.join(names)}"], check=True, capture_output=True, text=True).stdout
    printed = lines_of(output)
    found = [(claim, test, "; ".join(line for line in printed.get(test, ()) if re.search(pattern, line))) for claim, test, pattern in CLAIMS]
    if silent := [test for _, test, text in found if not text]:
        raise SystemExit(f"print nothing: {', '.join(silent)}")
    return found


TABLE = Table("claims of papers: figures that tests print", "Errors, shares and counts of the tests' own scenes; they depend on no load.", ("claim", "test of `maps_test`", "what it prints"),
              (None, None, None), rows)

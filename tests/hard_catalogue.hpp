// The hard cases whose answers are exact, for desktop and boards alike: test_hard_catalogue.cpp runs them
// under GoogleTest, firmware/catalogue.cpp on a board. Coordinates and directions are rational numbers that a
// number system holds, or rounds once; whether a ray meets a shape follows from integers. So nothing here
// needs a library, and what decides is never the code under test.
#pragma once

#include "hard/cones.hpp"
#include "hard/flat.hpp"
#include "hard/numbers.hpp"
#include "hard/spheres.hpp"

// All of them.
#define QRAY_CATALOGUE(X)                            \
    X(SphereTouchedByATangentOfIntegers)             \
    X(SphereAimedAMillionthOfItsRadiusBesideItsEdge) \
    X(SphereOfAnEleventhousandthOfItsDistance)       \
    X(SphereSeenFromAnywhereBesideItsEdge)           \
    X(SmallSphereSeenFromAnywhereBesideItsEdge)      \
    X(SphereSeenFromItsCentreIsItsRadiusAway)        \
    X(SphereBehindIsNotMet)                          \
    X(ConcentricSpheresAMillionthApartAreMetInOrder) \
    X(ShellOfAMillionthIsCrossedFaceByFace)          \
    X(SphereLeftAlmostAlongItsTangentIsNotMetAgain)  \
    X(SphereEnteredIsMetAtTheFarEndOfTheChord)       \
    X(PlaneParallelToTheRayIsMissed)                 \
    X(PlaneAtASlopeOfABillionthIsMetWhereItShouldBe) \
    X(DiscExactlyAtTheLimitIsMet)                    \
    X(PlaneThroughTheOriginOfARayIsNotMet)           \
    X(DiscHoldsItsRimAndNothingBeyond)               \
    X(RayThroughACornerOfSixTrianglesHasOneOwner)    \
    X(SliverOf50ByAHundredthousandthIsExact)         \
    X(TriangleOfAFiveThousandthIsExact)              \
    X(TriangleAsLargeAsTheWorldIsExact)              \
    X(ConcavePolygonOf144CornersIsExact)             \
    X(PolygonWithoutAreaIsNeverMet)                  \
    X(PolygonIsNotMetByARayInItsPlane)               \
    X(PolygonAlmostEdgeOnIsMetWithinItself)          \
    X(CylinderIsNotMetAlongItsAxis)                  \
    X(CylinderGrazedAFourmillionthInsideAndOutside)  \
    X(CylinderHoldsItsRimsAndNothingBeyond)          \
    X(ConeEndsAtItsApex)                             \
    X(ConeSeenAlongAGeneratorIsMetOnItOrNot)         \
    X(ConeSeenParallelToAGenerator)                  \
    X(OtherNappeIsNeverMet)                          \
    X(ConeSeenFromInsideIsMetOnce)                   \
    X(ConeEnteredFromBelowAndFromAbove)              \
    X(RefractionAMillionthOffTheCriticalAngle)       \
    X(SlabLetsOutWhatCameInParallel)                 \
    X(ThousandBouncesKeepTheDirectionUnit)           \
    X(ThousandBouncesBetweenTwoBallsKeepTheDirectionUnit) \
    X(TextureCellsAMillionAwayAreRight)              \
    X(MostNegativeIntegers)                          \
    X(DotsOfThreeMaxima)                             \
    X(NormaliseOfASingleRawUnit)                     \
    X(NormaliseOfZeroIsRefused)                      \
    X(RootsOfZeroAndOfTheLargestArea)                \
    X(PowersNearOneAndOfZero)

// Every number that decides when a batch is not to be trusted, and what is done then. After each: its unit, why it is that, and
// the scene or test that needs it ("survival N" is scene N of `pliant bench survival`, docs/stability.md).
#pragma once
#include <cstdint>

namespace pliant {

// Motion: [edges of the element per step]; steps below half the first take less (Recovery::fast_share).

/// The largest increment, in shortest elements, from which on nobody may assume that the step is short enough: elements are
/// looked at one by one. More often costs a look per batch; Calm.PiecesThatFlyAreLeftAlone counts those of a body that only
/// flies.
inline constexpr double kFastIncrement = 0.1;
/// What the nodes of an element may keep against each other: at half the velocity of sound, the stable step is about half the
/// time in which sound crosses an edge. Calm.KeepsMomentumAndBringsFastMotionDown; SoftHybrid.FallsApartAndGoesOn flies apart
/// without.
inline constexpr double kFastest = 0.25;
/// Twice what a batch begins with at most: the element has burst, even if its numbers are finite still, and what it did cannot
/// be calmed. At 2 sudden tractions tore boxes (sweep `load` of bench stability). Settled.ABatchThatIsMadeAgainHasToldNothing.
inline constexpr double kBurst = 0.5;
/// [share of kFastest] What an element that shares no node with another keeps: it vibrates alone, undamped perhaps. This leaves
/// it strains of a few percent, far from where laws stiffen. Calm.AnElementThatIsAloneKeepsAFifth; crumbs of survival 441 and
/// 987.
inline constexpr double kLone = 0.2;

// Substeps of shape matching.

/// [steps] With so many torn hybrids came to their end that 2 to 8 drove apart, whatever the step: Substeps.*,
/// docs/stability.md.
inline constexpr std::int32_t kSafeSubsteps = 1;

// Length of the step.

/// [share] What is left of an automatic step, and of the trust in its estimate, each time that a batch is lost or has burst;
/// and by what trust comes back. Resume.AutomaticStepThatWasTriedAgain.
inline constexpr double kBackoff = 0.7;
/// [share of the estimate] Below so little trust (ten times kBackoff) a batch is given up; in steps of the first, no state that
/// inverted elements outgrew takes less. At 0.1 sudden tractions ended that are carried now (sweep `load`).
/// CheckScenes.* ends one scene by it.
inline constexpr double kLeastBackoff = 0.02;
/// [share of the step] A batch is made again with a step that is shorter by this at least: for a thousandth less it would be
/// made again a hundred times. Resume.AutomaticStepThatElementsOutgrew, FlsmResume.AutomaticStepThatWasTriedAgain.
inline constexpr double kLeastShortening = 0.9;
/// [share of the step] And by this at most, however little one state stands: one element that is lost for a moment would make
/// the whole scene slow. StepRetries.StopAtTheFloorBeforeTheyGoBelow.
inline constexpr double kMostShortening = 0.35;
/// [share of the first step] No estimate takes an automatic step below: what asks for less is lost, and comes back only if it
/// is calmed. At a fiftieth sudden tractions diverged. StepRetries.NoEstimateTakesTheStepBelowAThousandth.
inline constexpr double kLeastShare = 1e-3;

// Ballast.

/// [share of the mass] More inertia changes what a scene does and helps little: 5 % lift 4 of 39 scenes of the survival bench
/// above a tenth of their first step, 20 % make one of them thirty times slower (docs/stability.md).
inline constexpr double kMostBallast = 0.01;
/// [share of the step] Where the ballast for a step is too much, that for this shorter one is tried. As kMostBallast.
inline constexpr double kBallastStride = 0.8;

}  // namespace pliant

// All numbers that decide when a batch is unreliable and which remedy follows. Each is followed by its unit, its reason, and
// the scene or test that needs it ("survival N" is scene N of `pliant bench survival`, docs/stability.md).
#pragma once
#include <cstdint>

namespace pliant {

// Motion: [edges of the element per step]; reduced for steps below half of the first (Recovery::fast_share).

/// Largest increment, in units of the shortest element edge, above which elements are checked one by one because the step may
/// be too long. A lower value costs a check per batch. Calm.PiecesThatFlyAreLeftAlone counts the checks of a body in free
/// flight.
inline constexpr double kFastIncrement = 0.1;
/// Relative motion to which calm() reduces the nodes of an element. The stable step is about half the time in which sound
/// crosses an edge, so this is half the velocity of sound. Calm.KeepsMomentumAndBringsFastMotionDown;
/// SoftHybrid.FallsApartAndGoesOn breaks apart without it.
inline constexpr double kFastest = 0.25;
/// Twice the largest relative motion at the start of a batch. Beyond this the element has burst, even if its numbers are
/// still finite, and calming cannot repair it. With 2, sudden tractions tore boxes (sweep `load` of bench stability).
/// Settled.ABatchThatIsMadeAgainHasToldNothing.
inline constexpr double kBurst = 0.5;
/// [fraction of kFastest] Limit for an element that shares no node with another, which can vibrate undamped. Its strains stay
/// within a few percent, far from where laws stiffen. Calm.AnElementThatIsAloneKeepsAFifth; isolated elements of survival 441
/// and 987.
inline constexpr double kLone = 0.2;

// Substeps of shape matching.

/// [steps] With one substep, torn hybrids completed their runs that diverged with 2 to 8, whatever the step size: Substeps.*,
/// docs/stability.md.
inline constexpr std::int32_t kSafeSubsteps = 1;

// Length of the step.

/// [fraction] Factor on an automatic step, and on the trust in its estimate (StepLimit::dt_backoff), each time a batch is
/// lost or has burst. Trust grows back by its inverse. Resume.AutomaticStepThatWasTriedAgain.
inline constexpr double kBackoff = 0.7;
/// [fraction of the estimate] Below this trust (ten times kBackoff) a lost batch is a divergence. In fractions of the first
/// step, it is also the lower bound of the step for states that inverted elements outgrew. With 0.1, sudden tractions
/// diverged that now complete (sweep `load`). CheckScenes.* has one scene that ends this way.
inline constexpr double kLeastBackoff = 0.02;
/// [fraction of the step] A repeated batch uses a step shortened at least to this; in steps of 0.1 % it could be repeated a
/// hundred times. Resume.AutomaticStepThatElementsOutgrew, FlsmResume.AutomaticStepThatWasTriedAgain.
inline constexpr double kLeastShortening = 0.9;
/// [fraction of the step] And at most to this, whatever a single state requires: otherwise one element that fails for a
/// moment would slow down the whole scene. StepRetries.StopAtTheFloorBeforeTheyGoBelow.
inline constexpr double kMostShortening = 0.35;
/// [fraction of the first step] Estimates never reduce an automatic step below this. Elements that require less are lost and
/// recover only if they are calmed. At a fiftieth sudden tractions diverged.
/// StepRetries.NoEstimateTakesTheStepBelowAThousandth.
inline constexpr double kLeastShare = 1e-3;

// Ballast.

/// [fraction of the mass] More added inertia changes the result and helps little: 5 % lift 4 of 39 scenes of the survival
/// bench above a tenth of their first step, 20 % make one of them thirty times slower (docs/stability.md).
inline constexpr double kMostBallast = 0.01;
/// [fraction of the step] Where the ballast for a step exceeds the limit, the ballast for this shorter step is tried. As
/// kMostBallast.
inline constexpr double kBallastStride = 0.8;

}  // namespace pliant

// The outcome of a comparison in a sentence or two.
#pragma once

#include "comparison.h"

#include <string>

namespace brume
{

/// What was measured, in plain words, whichever way it came out; plain text, e.g.
///
///     Brume ray march drew this in 0.081 s, 1.9 times as fast as VTK fixed point (0.154 s), with
///     a third of its mean error (0.21/255 against 0.63/255).
///
/// The subject (subject_of()) is set against the reference mapper. The rules:
/// - Speed is the ratio of the medians, given as "times as fast" or "times as long". It counts as
///   the same when the medians are within 5 %, or when each lies between the other's fastest and
///   slowest repetition.
/// - Error is the mean absolute error against the truth. It counts as the same within 5 %. Where
///   one is no larger than the truth's own remaining mean error, no ratio is given, and where both
///   are, the sentence says that the truth cannot tell them apart.
/// - A picture with non-finite values is said to have them, and no ratio is given.
/// - "but" joins a gain to a loss, "and" or "with" gain to gain and loss to loss.
/// Without a reference that was drawn the sentence gives the subject's own figures; when nothing
/// was drawn it says so.
VTKBRUMEANALYSIS_EXPORT std::string headline(const Comparison& comparison);

}

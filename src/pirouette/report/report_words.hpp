// The words of the reports, and what fills them; for this folder only. {name} stands for a value.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace pirouette {

/// `text` with each {name} replaced by the value of that name. A name without a value stays.
std::string fill(std::string_view text,
                 std::initializer_list<std::pair<std::string_view, std::string>> values);

/// The texts with `separator` between them.
template <class Texts>
std::string joined_by(std::string_view separator, const Texts& texts) {
  std::string all;
  std::string_view before;
  for (const std::string& text : texts) {
    all.append(before).append(text);
    before = separator;
  }
  return all;
}

/// Of every report.
namespace report_words {

inline constexpr const char* kTitle =
    "# {title}\n\npirouette {version} ({commit}), MuJoCo {mujoco}. {size}.\n";
inline constexpr const char* kNote = "\n{note}\n";
inline constexpr const char* kHolds = "holds";

}  // namespace report_words

/// Of experiments with seeds.
namespace report_words::comparison {

inline constexpr const char* kOneSeed = "Mean ± standard deviation over {seeds} seed{source}";
inline constexpr const char* kSeeds = "Mean ± standard deviation over {seeds} seeds{source}";
inline constexpr const char* kSource = "; printed: {source}";
inline constexpr const char* kProfile = "\n## Plant: {profile}\n\n";
inline constexpr const char* kEverywhere = "Everywhere: {values}.\n\n";
inline constexpr const char* kContext = "{name} {value}{unit}";

inline constexpr const char* kRow = "row";
inline constexpr const char* kFalls = "falls";
inline constexpr const char* kPrinted = "printed";
inline constexpr const char* kFallsOfTrials = "{falls} of {trials}";
inline constexpr const char* kAbsent = "-";

inline constexpr const char* kNoTrialFell = "\nNo trial fell.\n";
inline constexpr const char* kFallsTitle = "\nFalls:\n\n";
inline constexpr const char* kFall = "- {place}: {falls}{after}\n";
inline constexpr const char* kFallTime = ", after {time} s";

inline constexpr const char* kAgainstPrinted = "\nAgainst the printed figures:\n\n";
inline constexpr const char* kEveryTrialFell = "- {place}: every trial fell.\n";
inline constexpr const char* kDifferences = "- {place}: {differences}{bias}{drift}.\n";
inline constexpr const char* kDifference = "{quantity} {ours} vs {printed}{unit} ({difference})";
inline constexpr const char* kMore = "{number} more";
inline constexpr const char* kOppositeSign = "opposite sign";
inline constexpr const char* kTimes = "{number} times";
inline constexpr const char* kPart = "1/{number}";
inline constexpr const char* kBias =
    ". Body-frame bias {bias} mm/s, which draws a circle of {circle} mm; position estimate off by "
    "{odometry} mm";
inline constexpr const char* kDrift = "; drift {drift} mm per turn";

inline constexpr const char* kNotSaid =
    "\nThe source does not say which {key} its figures hold for: {values}. How far ours is from "
    "them, as a factor (geometric mean over what is printed):\n\n";
inline constexpr const char* kFactors = "- {paper}: {nearest} ({factors}).\n";
inline constexpr const char* kNearest = "nearest is {value}";
inline constexpr const char* kNothingToCompare = "nothing to compare";
inline constexpr const char* kAllTogether = "all together";
inline constexpr const char* kFell = "fell";

inline constexpr const char* kBiasShare =
    "\nThe circle that the body-frame bias draws (bias / yaw rate) is {middle} of the radius "
    "measured in the median over these rows (quartiles {low} and {high}).\n";

inline constexpr const char* kLadder =
    "\nThe ladder, {quantity} (each step should be smaller than the one before):\n\n";
inline constexpr const char* kRungs = "- {place}: {rungs}: {verdict}.\n";
inline constexpr const char* kEveryPlace = "everywhere";
inline constexpr const char* kIncomplete = "incomplete";
inline constexpr const char* kDoesNotHold = "does not hold, {row} is no better";

inline constexpr const char* kAcceptance =
    "\n## Acceptance: {held} of {bounds} bounds hold\n\n"
    "| row | quantity | allowed | measured | |\n|---|---|---|---|---|\n";
inline constexpr const char* kBound =
    "| {place} | {quantity} | {allowed} | {measured} | {verdict} |\n";
inline constexpr const char* kMissed = "**missed**: {why}";
inline constexpr const char* kMin = ">= {min}";
inline constexpr const char* kMax = "<= {max}";
inline constexpr const char* kShare = " ({base}{share} of {row})";
inline constexpr const char* kBase = "{max} + ";

/// Why a bound is missed, after the metric's name.
inline constexpr const char* kMissedBound = "{place} ({profile}): {metric} {why}";
inline constexpr const char* kTrialsFell = "counts as missed, {falls} trials fell";
inline constexpr const char* kIsAbsent = "is absent";
inline constexpr const char* kOtherAbsent = "cannot be judged: it is absent in {row}";
inline constexpr const char* kBelow = "{value}, below {limit}";
inline constexpr const char* kAbove = "{value}, above {limit}";

}  // namespace report_words::comparison

/// Of experiments whose trials are drawn.
namespace report_words::survival {

inline constexpr const char* kSize = "{trials} trials, seed of the draws {seed}";
inline constexpr const char* kAll = "all";
inline constexpr const char* kDrawn =
    "\n## Drawn for each trial\n\n| parameter | rows | values |\n|---|---|---|\n{draws}"
    "| run.seed | all | of noise, biases and terrain |\n";
inline constexpr const char* kDraw = "| {key} | {rows} | {values} |\n";

inline constexpr const char* kSurvival =
    "\n## Survival\n\n| row | trials | falls | survived | 95 % interval (Wilson) |\n"
    "|---|---|---|---|---|\n";
inline constexpr const char* kGroup =
    "| {row} | {trials} | {falls} | {survived} | {low} to {high} |\n";
inline constexpr const char* kStoodDown =
    "\nOf {falls} falls {stood_down} ended in the controller's stand-down{latest}.\n";
inline constexpr const char* kLatest = ", at most {delay} s after the fall";
inline constexpr const char* kAllowed = "\nAllowed are {falls} falls: {verdict}.\n";
inline constexpr const char* kMissed = "**missed**";

inline constexpr const char* kQuantiles =
    "\n## Quantiles over the trials without a fall\n\n| quantity | row |{shares}\n"
    "|---|---|---|---|---|---|---|\n";
inline constexpr const char* kShare = " {percent} % |";
inline constexpr const char* kLargest = " largest |";
inline constexpr const char* kQuantity = "| {quantity} | {row} |{values}\n";
inline constexpr const char* kQuantile = " {value} |";
inline constexpr const char* kAbsent = "-";

inline constexpr const char* kWorst =
    "\n## The worst trials, and how to repeat them\n\n"
    "Falls first, the earliest before the others, then by {quantity}.\n";
inline constexpr const char* kTrial =
    "\nTrial {number}, {row}, seed {seed}: {outcome}\n\n    {command}\n";
inline constexpr const char* kFell = "fell after {time} s";
inline constexpr const char* kSizeOfTrial = "{quantity} {value}";

inline constexpr const char* kTooManyFell = "{falls} of {trials} trials fell; allowed: {allowed}";
inline constexpr const char* kNotStoodDown =
    "{rest} of {falls} falls did not end in the stand-down";

}  // namespace report_words::survival

}  // namespace pirouette

// Two pictures in one viewport.
#pragma once

#include "layout.h"

#include "Analysis/picture.h"

#include <string>
#include <vector>

namespace brume::app
{

/// The picture at another size, linear between pixels' centres.
Picture resized(const Picture& picture, int width, int height);

/// One picture to the left of column `divider` and the other from there on, with a line between. Both of
/// one size.
Bitmap wiped(const Bitmap& left, const Bitmap& right, int divider);

/// Lines of text in a box of this size, broken between words and cut off where they do not fit.
Bitmap page_of(const std::vector<std::string>& paragraphs, int width, int height, const Metrics& metrics);

/// Two columns of text, as help is: keys and what they do. Where it does not fit the lettering is smaller,
/// down to 8 pixels, and then what is too long is cut.
Bitmap table_of(const std::vector<std::pair<std::string, std::string>>& rows, int width, int height,
  const Metrics& metrics);

/// One line in a strip, what is more important to the left.
struct Caption
{
  std::string left;
  std::string right;
};

/// The size of letters, in pixels, in which a caption fits a strip of that width: Metrics::text, or less, down to half
/// of it; 0 where it does not fit then.
int caption_size(const Caption& caption, int width, const Metrics& metrics);

/// The strip, in letters of that size; what does not fit is cut.
Bitmap caption_of(
  const Caption& caption, int size, int width, int height, const Metrics& metrics);

}

#include "painter.h"

#include "own_painter.h"
#include "stock_painter.h"

namespace brume::app
{

std::unique_ptr<Painter> make_painter(MapperKind kind)
{
  if (is_own(kind))
  {
    return std::make_unique<OwnPainter>(kind);
  }
  return std::make_unique<StockPainter>(kind);
}

}

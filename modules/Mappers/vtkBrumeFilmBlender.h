// Puts a film into a VTK frame. Internal to Mappers.
#ifndef vtkBrumeFilmBlender_h
#define vtkBrumeFilmBlender_h

#include "vtkObject.h"

#include <memory>
#include <vector>

namespace brume
{
struct Film;
}
class vtkOpenGLQuadHelper;
class vtkRenderer;
class vtkTextureObject;
class vtkWindow;

/// Blends a film over what is already in a renderer's viewport: radiance + transmittance · frame,
/// without touching the depth buffer. Pixel for pixel and without filtering where the film is as
/// large as the viewport; one of another size is stretched over it, bilinear.
class vtkBrumeFilmBlender : public vtkObject
{
public:
  static vtkBrumeFilmBlender* New();
  vtkTypeMacro(vtkBrumeFilmBlender, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Returns false where the renderer's window is not an OpenGL one.
  bool Blend(const brume::Film& film, vtkRenderer* renderer);

  void ReleaseGraphicsResources(vtkWindow* window);

protected:
  vtkBrumeFilmBlender();
  ~vtkBrumeFilmBlender() override;

private:
  vtkBrumeFilmBlender(const vtkBrumeFilmBlender&) = delete;
  void operator=(const vtkBrumeFilmBlender&) = delete;

  vtkTextureObject* Texture;
  std::unique_ptr<vtkOpenGLQuadHelper> Quad;
  std::vector<float> Pixels;
};

#endif

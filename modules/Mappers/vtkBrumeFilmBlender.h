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
class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkTextureObject;
class vtkWindow;

/// Blends a film over what is already in a renderer's viewport: radiance + transmittance · frame, each
/// channel for itself, without touching the depth buffer. Pixel for pixel and without filtering where the film is as
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

  /// Pixels of a plane for each of R, G and B, with the mean opacity or transmittance as the fourth.
  void Fill(const brume::Film& film, const std::vector<float> (&rgb)[3], bool opacity);
  bool Draw(const brume::Film& film, vtkOpenGLRenderWindow* window, bool interpolate);

  vtkTextureObject* Texture;
  std::unique_ptr<vtkOpenGLQuadHelper> Quad;
  std::vector<float> Pixels;
};

#endif

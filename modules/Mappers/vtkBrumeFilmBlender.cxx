#include "vtkBrumeFilmBlender.h"

#include "Transport/film.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

namespace
{

// The quad fills the viewport. A film as large has one texel a pixel; another one is interpolated.
const char* const FragmentShader = R"(//VTK::System::Dec
//VTK::Output::Dec
uniform sampler2D film;
uniform int interpolate;
in vec2 texCoord;
void main()
{
  gl_FragData[0] = interpolate != 0
    ? texture(film, texCoord)
    : texelFetch(film, ivec2(texCoord * vec2(textureSize(film, 0))), 0);
}
)";
}

vtkStandardNewMacro(vtkBrumeFilmBlender);

vtkBrumeFilmBlender::vtkBrumeFilmBlender()
  : Texture(vtkTextureObject::New())
{
}

vtkBrumeFilmBlender::~vtkBrumeFilmBlender()
{
  this->Texture->Delete();
}

bool vtkBrumeFilmBlender::Blend(const brume::Film& film, vtkRenderer* renderer)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window)
  {
    return false;
  }
  this->Texture->SetContext(window);
  int width = 0;
  int height = 0;
  renderer->GetTiledSize(&width, &height);
  const bool interpolate = film.width != width || film.height != height;
  const int filter = interpolate ? vtkTextureObject::Linear : vtkTextureObject::Nearest;
  this->Texture->SetMinificationFilter(filter);
  this->Texture->SetMagnificationFilter(filter);
  this->Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  this->Texture->SetWrapT(vtkTextureObject::ClampToEdge);

  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglEnableDisable blending(state, GL_BLEND);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_FALSE);
  state->vtkglEnable(GL_BLEND);
  const bool grey =
    film.transmittance[0] == film.transmittance[1] && film.transmittance[0] == film.transmittance[2];
  if (!grey)
  {
    // Blending has one opacity for R, G and B: the frame is dimmed first, each channel for itself.
    this->Fill(film, film.transmittance, false);
    state->vtkglBlendFuncSeparate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_SRC_ALPHA);
    if (!this->Draw(film, window, interpolate))
    {
      return false;
    }
  }
  this->Fill(film, film.radiance, true);
  const GLenum kept = grey ? GL_ONE_MINUS_SRC_ALPHA : GL_ONE;
  state->vtkglBlendFuncSeparate(GL_ONE, kept, GL_ONE, kept);
  return this->Draw(film, window, interpolate);
}

void vtkBrumeFilmBlender::Fill(const brume::Film& film,
  const std::vector<float> (&rgb)[3],
  bool opacity)
{
  this->Pixels.resize(4 * film.size());
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    float hidden = 1.0f;
    for (int c = 0; c < 3; ++c)
    {
      this->Pixels[4 * i + c] = rgb[c][i];
      hidden -= film.transmittance[c][i] / 3.0f;
    }
    this->Pixels[4 * i + 3] = opacity ? hidden : 1.0f - hidden;
  }
}

bool vtkBrumeFilmBlender::Draw(const brume::Film& film,
  vtkOpenGLRenderWindow* window,
  bool interpolate)
{
  if (!this->Texture->Create2DFromRaw(static_cast<unsigned int>(film.width),
        static_cast<unsigned int>(film.height),
        4,
        VTK_FLOAT,
        this->Pixels.data()))
  {
    return false;
  }
  if (!this->Quad)
  {
    this->Quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr, FragmentShader, "");
  }
  else
  {
    window->GetShaderCache()->ReadyShaderProgram(this->Quad->Program);
  }
  if (!this->Quad->Program)
  {
    return false;
  }
  this->Texture->Activate();
  this->Quad->Program->SetUniformi("film", this->Texture->GetTextureUnit());
  this->Quad->Program->SetUniformi("interpolate", interpolate);
  this->Quad->Render();
  this->Texture->Deactivate();
  return true;
}

void vtkBrumeFilmBlender::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Quad.reset();
  this->Texture->ReleaseGraphicsResources(window);
}

void vtkBrumeFilmBlender::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Texture: " << this->Texture << "\n";
}

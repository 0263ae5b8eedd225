/* An open context is current on the thread that opened it, without any surface: all drawing goes to
 * framebuffer objects. */
#include "cloth/view/view.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <stdbool.h>
#include <stdlib.h>

struct view_context {
    EGLDisplay display;
    EGLContext context;
};

static const char ADVICE[] =
    "install libegl1, libegl-mesa0, libgl1 and libgl1-mesa-dri (Debian's names)";

/* epoxy opens these itself at the first call, and ends the program where they are missing. */
static bool has_libraries(void)
{
    void *gl = dlopen("libOpenGL.so.0", RTLD_LAZY);
    gl = gl ? gl : dlopen("libGL.so.1", RTLD_LAZY);
    if (gl)
        dlclose(gl);
    return gl && epoxy_has_egl();
}

static EGLDisplay initialised(EGLDisplay display)
{
    return display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL) ? display
                                                                           : EGL_NO_DISPLAY;
}

static EGLDisplay device_display(void)
{
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"))
        return EGL_NO_DISPLAY;
    EGLDeviceEXT device[16];
    EGLint n = 0;
    if (!eglQueryDevicesEXT(16, device, &n))
        return EGL_NO_DISPLAY;
    EGLDisplay display = EGL_NO_DISPLAY;
    for (EGLint i = 0; i < n && display == EGL_NO_DISPLAY; i++)
        display = initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device[i], NULL));
    return display;
}

static EGLDisplay any_display(void)
{
    EGLDisplay display = EGL_NO_DISPLAY;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        display = initialised(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL));
    return display != EGL_NO_DISPLAY ? display : device_display();
}

static EGLContext make_context(EGLDisplay display)
{
    static const EGLint config_wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                         EGL_NONE};
    static const EGLint wish[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  3,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  3,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                  EGL_NONE};
    EGLConfig config;
    EGLint n = 0;
    if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, config_wish, &config, 1, &n) ||
        n < 1)
        return EGL_NO_CONTEXT;
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, wish);
    if (context == EGL_NO_CONTEXT)
        return EGL_NO_CONTEXT;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        return context;
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
}

int view_context_open(struct view_context **context, struct cloth_error *error)
{
    *context = NULL;
    if (!has_libraries())
        return cloth_fail(error, CLOTH_E_LIBRARY, "pictures need OpenGL and EGL: %s", ADVICE);
    struct view_context *made = calloc(1, sizeof *made);
    if (!made)
        return cloth_fail(error, CLOTH_E_MEMORY, "no memory for OpenGL");
    made->display = any_display();
    if (made->display == EGL_NO_DISPLAY) {
        free(made);
        return cloth_fail(error, CLOTH_E_LIBRARY, "EGL offers no display without a window: %s",
                          ADVICE);
    }
    made->context = make_context(made->display);
    if (made->context == EGL_NO_CONTEXT) {
        EGLint reason = eglGetError();
        view_context_close(made);
        return cloth_fail(error, CLOTH_E_LIBRARY, "EGL gives no OpenGL 3.3 (EGL error 0x%x): %s",
                          (unsigned)reason, ADVICE);
    }
    *context = made;
    return 0;
}

void view_context_close(struct view_context *context)
{
    if (!context)
        return;
    if (context->context != EGL_NO_CONTEXT) {
        eglMakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(context->display, context->context);
    }
    eglReleaseThread();
    free(context); /* the display is the process's: EGL gives the same one to all callers */
}

/* Every program is DRAW_COMMON followed by its own text, in both of its shaders. */
#include "cloth/view/draw/draw.h"

static int compile(GLuint *shader, GLenum kind, const char *text, struct cloth_error *error)
{
    const char *part[] = {DRAW_COMMON, text};
    *shader = glCreateShader(kind);
    glShaderSource(*shader, 2, part, NULL);
    glCompileShader(*shader);
    GLint good = GL_FALSE;
    glGetShaderiv(*shader, GL_COMPILE_STATUS, &good);
    if (good)
        return 0;
    char log[512] = "";
    glGetShaderInfoLog(*shader, sizeof log, NULL, log);
    return cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL refused a shader: %s", log);
}

static int link_program(GLuint program, struct cloth_error *error)
{
    glLinkProgram(program);
    GLint good = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good) {
        GLuint block = glGetUniformBlockIndex(program, "Lights");
        if (block != GL_INVALID_INDEX)
            glUniformBlockBinding(program, block, 0);
        return 0;
    }
    char log[512] = "";
    glGetProgramInfoLog(program, sizeof log, NULL, log);
    return cloth_fail(error, CLOTH_E_LIBRARY, "OpenGL could not link shaders: %s", log);
}

int draw_program(GLuint *program, const char *vertex, const char *fragment,
                 struct cloth_error *error)
{
    GLuint shader[2] = {0, 0};
    *program = glCreateProgram();
    int code = compile(&shader[0], GL_VERTEX_SHADER, vertex, error);
    code = code ? code : compile(&shader[1], GL_FRAGMENT_SHADER, fragment, error);
    if (!code) {
        glAttachShader(*program, shader[0]);
        glAttachShader(*program, shader[1]);
        glBindAttribLocation(*program, 0, "position");
        glBindAttribLocation(*program, 1, "normal");
        glBindAttribLocation(*program, DRAW_VALUE, "value");
        code = link_program(*program, error);
    }
    glDeleteShader(shader[0]);
    glDeleteShader(shader[1]);
    return code;
}

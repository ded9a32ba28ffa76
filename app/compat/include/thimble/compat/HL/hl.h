#pragma once

/* Declarations for building a program that uses HL, the layer above HDAPI that takes shapes from
 * OpenGL. Thimble has no HL: no context can be created, every call leaves an error, and getters
 * return zeros. So a program that is linked with libHL starts, and its HDAPI part works. For C and
 * C++. Written for Thimble; names and types are those that public programs use
 * (app/compat/PROVENANCE.md). */

#include <HD/hd.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef const char* HLenum;
typedef const char* HLstring;
typedef unsigned char HLboolean;
typedef double HLdouble;
typedef float HLfloat;
typedef int HLint;
typedef int HLsizei;
typedef unsigned int HLuint;
typedef unsigned int HLbitfield;
typedef void* HHLRC;
typedef void HLcache;
typedef void HLgeom;

/** Error information, returned by value. */
typedef struct {
  HLenum errorCode;
  HDErrorInfo errorInfo;
} HLerror;

#define HLAPIENTRY
#define HLCALLBACK
#define HLAPI
#define HL_TRUE 1
#define HL_FALSE 0
#define HL_ERROR(X) ((X).errorCode != HL_NO_ERROR)

/** Any shape, for events. */
#define HL_OBJECT_ANY 0

/* Groups of attributes of hlPushAttrib. */
#define HL_HINT_BIT 0x01
#define HL_MATERIAL_BIT 0x02
#define HL_TOUCH_BIT 0x04
#define HL_TRANSFORM_BIT 0x08
#define HL_EFFECT_BIT 0x10
#define HL_EVENTS_BIT 0x20

#define THIMBLE_HL_CONSTANT(name) extern HLenum name;
#include <HL/hl_constants.inc>
#undef THIMBLE_HL_CONSTANT

typedef void (*HLcallbackProc)(void);
typedef void (*HLeventProc)(HLenum event, HLuint object, HLenum thread, HLcache* cache, void* data);
typedef void (*HLeffectProc)(HDdouble force[3], HLcache* cache, void* data);

/* Contexts, frames and errors. */
HLerror hlGetError(void);
HHLRC hlCreateContext(HHD device);
void hlDeleteContext(HHLRC context);
void hlMakeCurrent(HHLRC context);
void hlContextDevice(HHD device);
HHLRC hlGetCurrentContext(void);
HHD hlGetCurrentDevice(void);
void hlBeginFrame(void);
void hlEndFrame(void);
HLboolean hlDeploymentLicense(const char* vendor, const char* application, const char* password);
void hlUpdateCalibration(void);

/* State. A getter writes one zero: how many numbers a constant has is not known here. */
void hlEnable(HLenum capability);
void hlDisable(HLenum capability);
HLboolean hlIsEnabled(HLenum capability);
void hlGetBooleanv(HLenum parameter, HLboolean* values);
void hlGetDoublev(HLenum parameter, HLdouble* values);
void hlGetIntegerv(HLenum parameter, HLint* values);
HLstring hlGetString(HLenum name);
void hlHintb(HLenum target, HLboolean value);
void hlHinti(HLenum target, HLint value);
void hlCacheGetBooleanv(HLcache* cache, HLenum parameter, HLboolean* values);
void hlCacheGetDoublev(HLcache* cache, HLenum parameter, HLdouble* values);
void hlPushAttrib(HLbitfield groups);
void hlPopAttrib(void);

/* Shapes. */
HLuint hlGenShapes(HLsizei count);
void hlDeleteShapes(HLuint shape, HLsizei count);
HLboolean hlIsShape(HLuint shape);
void hlBeginShape(HLenum type, HLuint shape);
void hlEndShape(void);
void hlGetShapeBooleanv(HLuint shape, HLenum parameter, HLboolean* values);
void hlGetShapeDoublev(HLuint shape, HLenum parameter, HLdouble* values);
void hlLocalFeature1fv(HLgeom* geometry, HLenum type, const HLfloat* v);
void hlLocalFeature1dv(HLgeom* geometry, HLenum type, const HLdouble* v);
void hlLocalFeature2fv(HLgeom* geometry, HLenum type, const HLfloat* v1, const HLfloat* v2);
void hlLocalFeature2dv(HLgeom* geometry, HLenum type, const HLdouble* v1, const HLdouble* v2);
void hlCallback(HLenum type, HLcallbackProc callback, void* data);

/* Materials and touch. */
void hlMaterialf(HLenum face, HLenum parameter, HLfloat value);
void hlGetMaterialfv(HLenum face, HLenum parameter, HLfloat* values);
void hlTouchableFace(HLenum face);
void hlTouchModel(HLenum model);
void hlTouchModelf(HLenum parameter, HLfloat value);
void hlProxydv(HLenum parameter, const HLdouble* values);

/* Effects. */
HLuint hlGenEffects(HLsizei count);
void hlDeleteEffects(HLuint effect, HLsizei count);
HLboolean hlIsEffect(HLuint effect);
void hlStartEffect(HLenum type, HLuint effect);
void hlStopEffect(HLuint effect);
void hlUpdateEffect(HLuint effect);
void hlTriggerEffect(HLenum type);
void hlEffectd(HLenum property, HLdouble value);
void hlEffecti(HLenum property, HLint value);
void hlEffectdv(HLenum property, const HLdouble* values);
void hlEffectiv(HLenum property, const HLint* values);
void hlGetEffectdv(HLuint effect, HLenum property, HLdouble* values);
void hlGetEffectiv(HLuint effect, HLenum property, HLint* values);
void hlGetEffectbv(HLuint effect, HLenum property, HLboolean* values);

/* Events. */
void hlAddEventCallback(HLenum event, HLuint object, HLenum thread, HLeventProc callback,
                        void* data);
void hlRemoveEventCallback(HLenum event, HLuint object, HLenum thread, HLeventProc callback);
void hlEventd(HLenum parameter, HLdouble value);
void hlCheckEvents(void);

/* Matrices. */
void hlMatrixMode(HLenum mode);
void hlPushMatrix(void);
void hlPopMatrix(void);
void hlLoadIdentity(void);
void hlLoadMatrixd(const HLdouble* matrix);
void hlLoadMatrixf(const HLfloat* matrix);
void hlMultMatrixd(const HLdouble* matrix);
void hlMultMatrixf(const HLfloat* matrix);
void hlRotated(HLdouble angle, HLdouble x, HLdouble y, HLdouble z);
void hlRotatef(HLfloat angle, HLfloat x, HLfloat y, HLfloat z);
void hlScaled(HLdouble x, HLdouble y, HLdouble z);
void hlScalef(HLfloat x, HLfloat y, HLfloat z);
void hlTranslated(HLdouble x, HLdouble y, HLdouble z);
void hlTranslatef(HLfloat x, HLfloat y, HLfloat z);
void hlOrtho(HLdouble left, HLdouble right, HLdouble bottom, HLdouble top, HLdouble near_plane,
             HLdouble far_plane);
void hlWorkspace(HLdouble left, HLdouble bottom, HLdouble back, HLdouble right, HLdouble top,
                 HLdouble front);

#ifdef __cplusplus
}
#endif

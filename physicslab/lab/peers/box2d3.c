/* Box2D 3 behind plain calls of numbers, which any later layout of its structures leaves as they are.

   Compiled with Box2D's sources by box2d3_built.py, and called from there alone. A scene is one world; bodies
   go by the order in which they were added, from 0 on. Units are SI; angles by cosine and sine. */

#include "box2d/box2d.h"

#include <math.h>
#include <stdlib.h>

typedef struct Scene
{
	b2WorldId world;
	b2BodyId* bodies;
	int count, room;
} Scene;

/* The world takes the smaller restitution of a pair; Box2D's own rule is the larger. */
static float smaller( float a, uint64_t first, float b, uint64_t second )
{
	(void)first, (void)second;
	return a < b ? a : b;
}

Scene* scene_open( double gx, double gy )
{
	Scene* scene = calloc( 1, sizeof( Scene ) );
	b2WorldDef def = b2DefaultWorldDef();
	def.gravity = (b2Vec2){ (float)gx, (float)gy };
	def.restitutionCallback = smaller;
	def.enableSleep = false;
	def.workerCount = 1;
	scene->world = b2CreateWorld( &def );
	return scene;
}

void scene_close( Scene* scene )
{
	b2DestroyWorld( scene->world );
	free( scene->bodies );
	free( scene );
}

void scene_gravity( Scene* scene, double gx, double gy )
{
	b2World_SetGravity( scene->world, (b2Vec2){ (float)gx, (float)gy } );
}

/* state: x, y, cosine, sine, vx, vy, angular velocity; kind: 0 static, 1 kinematic, 2 dynamic */
int scene_body( Scene* scene, int kind, const double* state )
{
	b2BodyDef def = b2DefaultBodyDef();
	def.type = kind == 0 ? b2_staticBody : kind == 1 ? b2_kinematicBody : b2_dynamicBody;
	def.position.x = state[0], def.position.y = state[1];
	def.rotation = (b2Rot){ (float)state[2], (float)state[3] };
	def.linearVelocity = (b2Vec2){ (float)state[4], (float)state[5] };
	def.angularVelocity = (float)state[6];
	if ( scene->count == scene->room )
	{
		scene->room = 2 * scene->room + 64;
		scene->bodies = realloc( scene->bodies, scene->room * sizeof( b2BodyId ) );
	}
	scene->bodies[scene->count] = b2CreateBody( scene->world, &def );
	return scene->count++;
}

static b2ShapeDef surface( double friction, double restitution )
{
	b2ShapeDef def = b2DefaultShapeDef();
	def.material.friction = (float)friction;
	def.material.restitution = (float)restitution;
	return def;
}

void scene_disc( Scene* scene, int body, double radius, double friction, double restitution )
{
	b2ShapeDef def = surface( friction, restitution );
	b2Circle disc = { { 0.0f, 0.0f }, (float)radius };
	b2CreateCircleShape( scene->bodies[body], &def, &disc );
}

/* core: x, y of each of count vertices */
void scene_polygon( Scene* scene, int body, const double* core, int count, double radius, double friction,
					double restitution )
{
	b2ShapeDef def = surface( friction, restitution );
	b2Vec2 points[B2_MAX_POLYGON_VERTICES];
	for ( int i = 0; i < count; ++i )
	{
		points[i] = (b2Vec2){ (float)core[2 * i], (float)core[2 * i + 1] };
	}
	if ( count == 2 )
	{
		b2Capsule capsule = { points[0], points[1], (float)radius };
		b2CreateCapsuleShape( scene->bodies[body], &def, &capsule );
		return;
	}
	b2Hull hull = b2ComputeHull( points, count );
	b2Polygon polygon = b2MakePolygon( &hull, (float)radius );
	b2CreatePolygonShape( scene->bodies[body], &def, &polygon );
}

/* ends: x, y of one, x, y of the other */
void scene_wall( Scene* scene, int body, const double* ends, double friction, double restitution )
{
	b2ShapeDef def = surface( friction, restitution );
	b2Segment wall = { { (float)ends[0], (float)ends[1] }, { (float)ends[2], (float)ends[3] } };
	b2CreateSegmentShape( scene->bodies[body], &def, &wall );
}

/* After its shape, which sets a mass of its own. An inertia of 0 keeps a body from turning. */
void scene_mass( Scene* scene, int body, double mass, double inertia )
{
	b2MassData data = { (float)mass, { 0.0f, 0.0f }, (float)inertia };
	b2Body_SetMassData( scene->bodies[body], data );
}

/* The share of its velocity that a body loses a second. */
void scene_drag( Scene* scene, int body, double rate )
{
	b2Body_SetLinearDamping( scene->bodies[body], (float)rate );
}

/* anchors: x, y in the first body's frame, x, y in the other's */
void scene_spring( Scene* scene, int a, int b, const double* anchors, double length, double hertz, double damping )
{
	b2DistanceJointDef def = b2DefaultDistanceJointDef();
	def.base.bodyIdA = scene->bodies[a], def.base.bodyIdB = scene->bodies[b];
	def.base.localFrameA.p = (b2Vec2){ (float)anchors[0], (float)anchors[1] };
	def.base.localFrameB.p = (b2Vec2){ (float)anchors[2], (float)anchors[3] };
	def.base.collideConnected = true;
	def.length = (float)length;
	def.enableSpring = true;
	def.hertz = (float)hertz;
	def.dampingRatio = (float)damping;
	b2CreateDistanceJoint( scene->world, &def );
}

/* kind: 0 rod, 1 rope, 2 pin, 3 slot, 4 weld. numbers: x, y of the anchors; angles of the frames, in which the
   bodies are one, and whose x axis is that of a slot; length; lower and upper limit; speed and strength of the motor */
void scene_joint( Scene* scene, int kind, int a, int b, int collide, int limited, const double* numbers )
{
	b2JointDef base = b2DefaultWeldJointDef().base;
	base.bodyIdA = scene->bodies[a], base.bodyIdB = scene->bodies[b];
	base.localFrameA.p = (b2Vec2){ (float)numbers[0], (float)numbers[1] };
	base.localFrameB.p = (b2Vec2){ (float)numbers[2], (float)numbers[3] };
	base.localFrameA.q = (b2Rot){ (float)cos( numbers[4] ), (float)sin( numbers[4] ) };
	base.localFrameB.q = (b2Rot){ (float)cos( numbers[5] ), (float)sin( numbers[5] ) };
	base.collideConnected = collide != 0;
	float length = (float)numbers[6], lower = (float)numbers[7], upper = (float)numbers[8];
	float speed = (float)numbers[9], strongest = (float)numbers[10];
	if ( kind < 2 )
	{
		b2DistanceJointDef def = b2DefaultDistanceJointDef();
		def.base = base;
		def.length = length;
		def.enableSpring = def.enableLimit = kind == 1; /* without stiffness: it stops at its limit */
		def.hertz = 0.0f, def.minLength = 0.0f, def.maxLength = length;
		b2CreateDistanceJoint( scene->world, &def );
	}
	else if ( kind == 2 )
	{
		b2RevoluteJointDef def = b2DefaultRevoluteJointDef();
		def.base = base;
		def.enableLimit = limited != 0, def.lowerAngle = lower, def.upperAngle = upper;
		def.enableMotor = strongest > 0.0f, def.motorSpeed = speed, def.maxMotorTorque = strongest;
		b2CreateRevoluteJoint( scene->world, &def );
	}
	else if ( kind == 3 )
	{
		b2PrismaticJointDef def = b2DefaultPrismaticJointDef();
		def.base = base;
		def.enableLimit = limited != 0, def.lowerTranslation = lower, def.upperTranslation = upper;
		def.enableMotor = strongest > 0.0f, def.motorSpeed = speed, def.maxMotorForce = strongest;
		b2CreatePrismaticJoint( scene->world, &def );
	}
	else
	{
		b2WeldJointDef def = b2DefaultWeldJointDef();
		def.base = base;
		b2CreateWeldJoint( scene->world, &def );
	}
}

void scene_stiffness( Scene* scene, double hertz )
{
	b2WorldDef usual = b2DefaultWorldDef();
	b2World_SetContactTuning( scene->world, (float)hertz, usual.contactDampingRatio, usual.contactSpeed );
}

void scene_step( Scene* scene, double dt, int substeps, int steps )
{
	for ( int i = 0; i < steps; ++i )
	{
		b2World_Step( scene->world, (float)dt, substeps );
	}
}

/* out: x, y, vx, vy, angle, angular velocity of each body */
void scene_state( Scene* scene, double* out )
{
	for ( int i = 0; i < scene->count; ++i, out += 6 )
	{
		b2BodyId body = scene->bodies[i];
		b2Pos place = b2Body_GetPosition( body );
		b2Vec2 velocity = b2Body_GetLinearVelocity( body );
		out[0] = place.x, out[1] = place.y, out[2] = velocity.x, out[3] = velocity.y;
		b2Rot rotation = b2Body_GetRotation( body );
		out[4] = atan2( rotation.s, rotation.c ); /* its own is approximate */
		out[5] = b2Body_GetAngularVelocity( body );
	}
}

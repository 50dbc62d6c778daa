// Jolt's soft body, XPBD in single precision, on springs: compliances are 1/k, and the integrator is the number of
// sub-steps.

const {load, main, solve} = require("./program.js");

const layer = 0;

function world(Jolt) {
  const settings = new Jolt.JoltSettings();
  const pairs = new Jolt.ObjectLayerPairFilterTable(1);
  const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
  broad.MapObjectToBroadPhaseLayer(layer, new Jolt.BroadPhaseLayer(0));
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, pairs, 1);
  settings.mMaxWorkerThreads = 0;
  return new Jolt.JoltInterface(settings);
}

/** Vertices and edges. Its faces, which it wants, only collide. */
function cloth(Jolt, problem) {
  const shared = new Jolt.SoftBodySharedSettings();
  const held = new Set(problem.pinned);
  problem.mass.forEach((mass, i) => {
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    vertex.mPosition = new Jolt.Float3(...problem.positions.slice(3 * i, 3 * i + 3));
    vertex.mVelocity = new Jolt.Float3(...problem.velocities.slice(3 * i, 3 * i + 3));
    vertex.mInvMass = held.has(i) ? 0 : 1 / mass;
    shared.mVertices.push_back(vertex);
  });
  problem.ends.forEach(([i, j], k) => {
    const edge = new Jolt.SoftBodySharedSettingsEdge(i, j, 1 / problem.stiffness[k]);
    edge.mRestLength = problem.rest[k];
    shared.mEdgeConstraints.push_back(edge);
  });
  shared.Optimize();
  return shared;
}

main(async problem => {
  const {version, exported} = await load("jolt-physics", "dist/jolt-physics.wasm-compat.js");
  const Jolt = await exported.default();
  const jolt = world(Jolt), bodies = jolt.GetPhysicsSystem().GetBodyInterface();
  jolt.GetPhysicsSystem().SetGravity(new Jolt.Vec3(...problem.gravity));
  const creation = new Jolt.SoftBodyCreationSettings(
      cloth(Jolt, problem), new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), layer);
  creation.mNumIterations = Number(problem.integrator);
  creation.mLinearDamping = 0;
  creation.mMaxLinearVelocity = 1e6;
  creation.mUpdatePosition = false;
  creation.mAllowSleeping = false;
  const body = bodies.CreateSoftBody(creation);
  bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
  const vertices = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties).GetVertices();
  const numbers = get => problem.mass.flatMap((_, i) => {
    const a = get(vertices.at(i));
    return [a.GetX(), a.GetY(), a.GetZ()];
  });
  const frame = () => [numbers(vertex => vertex.mPosition), numbers(vertex => vertex.mVelocity)];
  return solve(problem, `Jolt ${version}, single precision`, () => jolt.Step(problem.step, 1), frame);
});

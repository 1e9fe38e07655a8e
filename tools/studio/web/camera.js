/* The camera of the preview: { eye, at, angle }, y up. `side` is 1 where right is up x forward, as in POV-Ray, -1 where
 * it is forward x up. */

const add = (a, b, t = 1) => a.map((x, i) => x + t * b[i]);
const minus = (a, b) => add(a, b, -1);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const scaled = (a, t) => a.map((x) => x * t);
const length = (a) => Math.hypot(...a);
const unit = (a) => scaled(a, 1 / (length(a) || 1));
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const radians = (degrees) => (degrees * Math.PI) / 180;

const STEEPEST = radians(89);
export const ANGLE_LEAST = 10, ANGLE_MOST = 120;

/* Where a direction points: round the vertical axis, and up. */
const turnOf = ([x, y, z]) => ({ yaw: Math.atan2(x, z), pitch: Math.asin(clamp(y, -1, 1)) });
const directionOf = ({ yaw, pitch }) => [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];

function turned(direction, right, up, side) {
  const { yaw, pitch } = turnOf(direction);
  return directionOf({ yaw: yaw + side * right, pitch: clamp(pitch + up, -STEEPEST, STEEPEST) });
}

/* Forward, right and up, unit vectors. */
export function axesOf({ eye, at }, side = 1) {
  const forward = unit(minus(at, eye));
  const right = unit(scaled(cross([0, 1, 0], forward), side)), up = scaled(cross(forward, right), side);
  return { forward, right, up };
}

/* Around what is looked at; radians to the right and up, as the eye moves. */
export function orbited(camera, right, up, side = 1) {
  const far = minus(camera.at, camera.eye);
  const direction = turned(unit(far), -right, -up, side);
  return { ...camera, eye: add(camera.at, direction, -length(far)) };
}

/* The eye stays, and turns. */
export function lookedRound(camera, right, up, side = 1) {
  const far = minus(camera.at, camera.eye);
  return { ...camera, at: add(camera.eye, turned(unit(far), right, up, side), length(far)) };
}

/* Steps in units of the scene: forward and right on the level, and up. */
export function walked(camera, { forward = 0, right = 0, up = 0 }, side = 1) {
  const axes = axesOf(camera, side), level = unit([axes.forward[0], 0, axes.forward[2]]);
  const step = add(add(scaled(level, forward), axes.right, right), [0, up, 0]);
  return { ...camera, eye: add(camera.eye, step), at: add(camera.at, step) };
}

/* Nearer to what is looked at, or farther: its distance times `factor`. */
export function dollied(camera, factor) {
  return { ...camera, eye: add(camera.at, minus(camera.at, camera.eye), -factor) };
}

/* To look at what is seen at x, y, from -1 to 1 to the right and up, in a picture of this aspect. */
export function aimed(camera, x, y, aspect, side = 1) {
  const { forward, right, up } = axesOf(camera, side), wide = Math.tan(radians(camera.angle) / 2);
  const direction = unit(add(add(forward, right, x * wide), up, (y * wide) / aspect));
  const { yaw, pitch } = turnOf(direction), far = length(minus(camera.at, camera.eye));
  return { ...camera, at: add(camera.eye, directionOf({ yaw, pitch: clamp(pitch, -STEEPEST, STEEPEST) }), far) };
}

export const angled = (camera, angle) => ({ ...camera, angle: clamp(angle, ANGLE_LEAST, ANGLE_MOST) });

/* What a walk's step is: a part of the scene, and half a metre at most. */
export function stepOf(bounds) {
  const size = bounds ? length(minus(bounds[1], bounds[0])) : 10;
  return Number.isFinite(size) ? Math.min(size / 40, 0.5) : 0.25;
}

export const sideOf = ({ eye, at, right }) => (right && dot(axesOf({ eye, at }).right, right) < 0 ? -1 : 1);

const rounded = (x) => String(Number(x.toFixed(4)) + 0);

/* As --camera takes it. */
export const cameraText = ({ eye, at, angle }) =>
  `${eye.map(rounded).join()}:${at.map(rounded).join()}:${rounded(angle)}`;

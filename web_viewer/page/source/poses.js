import {Matrix4, Quaternion, Vector3} from 'three';

const DEGREES = 180 / Math.PI;

/** A pose [tx, ty, tz, qw, qx, qy, qz] as a matrix, about the given origin (Vector3) of the scene. */
export function matrixOf(pose, origin) {
  const [x, y, z, qw, qx, qy, qz] = pose;
  const position = new Vector3(x - origin.x, y - origin.y, z - origin.z);
  return new Matrix4().compose(position, new Quaternion(qx, qy, qz, qw), new Vector3(1, 1, 1));
}

/** Whether single precision, that of the graphics card, holds these numbers. */
export function canBeDrawn(...numbers) {
  return numbers.every((number) => Number.isFinite(Math.fround(number)) && Math.abs(number) < 1e7);
}

/** Roll, pitch and heading in degrees: turns about x, then y, then z. */
export function anglesOf([, , , w, x, y, z]) {
  return {
    roll: DEGREES * Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    pitch: DEGREES * Math.asin(Math.min(1, Math.max(-1, 2 * (w * y - z * x)))),
    heading: DEGREES * Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  };
}

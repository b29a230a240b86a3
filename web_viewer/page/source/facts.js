import {anglesOf} from './poses.js';

// Text about things in the scene.

export function metres(value) {
  return `${value.toFixed(2)} m`;
}

function degrees(value) {
  return `${Math.round(value) + 0}°`;  // no -0
}

/** Pairs of name and text about a found object. sensor: its pose, or null. */
export function detectionFacts({class: name, pose, box, score, unseen_share: unseen}, sensor, provisional) {
  const [x, y, z] = pose;
  const {roll, pitch, heading} = anglesOf(pose);
  const facts = [
    ['class', name],
    ['score', score.toFixed(3)],
    ['position', `${x.toFixed(2)}, ${y.toFixed(2)}, ${z.toFixed(2)} m`],
    ['heading', degrees(heading)],
    ['roll, pitch', `${degrees(roll)}, ${degrees(pitch)}`],
    ['size', box[0].map((low, i) => (box[1][i] - low).toFixed(2)).join(' × ') + ' m'],
  ];
  if (sensor) facts.splice(2, 0, ['distance', metres(distanceOf(pose, sensor))]);
  if (provisional) facts.push(['provisional', `${Math.round(100 * unseen)} % of it not swept yet`]);
  return facts;
}

export function pointFacts([x, y, z], sensor) {
  return [
    ['position', `${x.toFixed(2)}, ${y.toFixed(2)}, ${z.toFixed(2)} m`],
    ['distance', metres(distanceOf([x, y, z], sensor))],
  ];
}

export function distanceOf(pose, sensor) {
  return Math.hypot(pose[0] - sensor[0], pose[1] - sensor[1], pose[2] - sensor[2]);
}

/** When a scan was made: the clock for times of our age, else seconds. utime: text, us. */
export function timeText(utime) {
  const AGE_BEGIN_MS = Date.UTC(1990, 0);
  const ms = Number(utime) / 1000;
  const date = new Date(ms);
  if (ms < AGE_BEGIN_MS || Number.isNaN(date.getTime())) return `${(ms / 1000).toFixed(1)} s`;
  return date.toISOString().slice(0, 21).replace('T', ' ');
}

export function minutes(seconds) {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
}

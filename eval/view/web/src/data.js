// What the page asks is answered by the program that serves it or, in a clip, lies in the page itself.
const clip = JSON.parse(document.getElementById("clip").textContent);

export const isClip = clip !== null;
/// Of a clip: what was left out, in words.
export const clipNote = clip?.note ?? "";
/// Of a clip: every how many events one is kept.
export const clipEvery = clip?.every ?? 1;

function fromClip(target) {
  const answer = clip.answers[target];
  if (!answer) return null;
  const text = atob(answer.base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Blob([bytes], { type: answer.type });
}

/// The answer to `target` ("events?recording=0&..."), null where there is no such thing. Throws what the program says is wrong.
export async function ask(target) {
  if (isClip) return fromClip(target);
  const response = await fetch(target);
  if (response.status === 404) return null;
  if (!response.ok) throw new Error(await response.text());
  return response.blob();
}

export async function askJson(target) {
  const answer = await ask(target);
  return answer && JSON.parse(await answer.text());
}

export async function askBytes(target) {
  const answer = await ask(target);
  return answer && answer.arrayBuffer();
}

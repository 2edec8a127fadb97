// What every page needs: questions to the service with its token, errors in the service's own words.

const TOKEN = "lifelore token";

/** An answer of the service that is an error. */
export class ServiceError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

/** Ask the service; the answer as JSON, or as a `Response` with `raw`. Asks the person for a token when it needs one. */
export async function ask(path, { method = "GET", body, raw = false, headers = {} } = {}) {
  const json = body !== undefined && !(body instanceof Blob) && !(body instanceof ArrayBuffer);
  const options = { method, headers: { ...headers } };
  if (json) options.headers["Content-Type"] = "application/json";
  if (body !== undefined) options.body = json ? JSON.stringify(body) : body;
  const token = sessionStorage.getItem(TOKEN);
  if (token) options.headers.Authorization = `Bearer ${token}`;
  let answer;
  try {
    answer = await fetch(path, options);
  } catch {
    throw new ServiceError(0, "The service does not answer; is `lifelore serve` still running?");
  }
  if (answer.status === 401 && askForToken()) return ask(path, { method, body, raw, headers });
  if (!answer.ok) throw new ServiceError(answer.status, await errorMessage(answer));
  return raw ? answer : answer.json();
}

/** Say something in an element: a message, a warning or an error; an empty text hides it. */
export function say(element, text, kind = "") {
  element.hidden = !text;
  element.textContent = text;
  element.className = `message ${kind}`.trim();
  element.setAttribute("role", kind === "error" ? "alert" : "status");
}

/** An element with attributes and children. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

function askForToken() {
  const token = prompt("This service needs a token:");
  if (token) sessionStorage.setItem(TOKEN, token.trim());
  return Boolean(token);
}

async function errorMessage(answer) {
  try {
    return (await answer.json()).error.message;
  } catch {
    return `The service answered ${answer.status}.`;
  }
}

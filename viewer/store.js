// What the browser remembers. Not every browser lets a local file remember; then nothing is.
export function recall(key) {
  try {
    return window.localStorage.getItem(key);
  } catch {
    return null;
  }
}

export function remember(key, value) {
  try {
    window.localStorage.setItem(key, String(value));
  } catch {
    // as good as a reader's first visit
  }
}

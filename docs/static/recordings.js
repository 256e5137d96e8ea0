// Puts a recording in the place of its picture where it comes into view. Opened as a file, a page keeps its pictures.
"use strict";

const dark = () => {
  const theme = document.body.dataset.theme;
  return theme === "dark" || (theme !== "light" && matchMedia("(prefers-color-scheme: dark)").matches);
};

const play = (link) => {
  const frame = document.createElement("iframe");
  frame.src = link.href + (dark() ? "&darkMode" : "");
  frame.title = link.querySelector("img").alt;
  link.after(frame);
  link.classList.add("played");
};

if (location.protocol !== "file:") {
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries.filter((each) => each.isIntersecting)) {
      seen.unobserve(entry.target);
      play(entry.target);
    }
  }, { rootMargin: "100px" });
  document.querySelectorAll("a.recording").forEach((link) => seen.observe(link));
}

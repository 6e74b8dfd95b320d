// A mesh as a Wavefront OBJ file has it: vertices `v`, normals `vn` and faces `f`, a statement a line. All else is
// passed over, and counted.
#pragma once

#include <charconv>

#include "reader.hpp"

namespace qray::scene {

class Obj : public Reader {
public:
    Obj(const char* path, std::string_view text, Error& to) : Reader(path, text.data(), text.size(), to) {}

    // What the text can hold at most, before it is checked.
    struct Size {
        size_t points = 0, normals = 0, triangles = 0;
    };
    Size size()
    {
        Size s;
        for_each_statement([&] {
            const bool face = statement.text == "f";
            s.points += statement.text == "v";
            s.normals += statement.text == "vn";
            for (uint64_t corners = 1; face && more(); corners++)
                s.triangles += corners > 2;
            return true;
        });
        return s;
    }

    // Reads all into arrays of that size. Of each face the corners, v scale + offset, and their normals come behind
    // what `d` has of them; then face(n, all of them have normals), which returns false where it has written an error.
    template <class Face>
    bool read(Description& d, double scale, const Vec3d& offset, Vec3d* points, Vec3d* normals, Face face)
    {
        uint32_t point_count = 0, normal_count = 0, faces = 0;
        const bool good = for_each_statement([&] {
            if (statement.text == "v")
                return vector("a vertex", points[point_count++]);
            if (statement.text == "vn") {
                Vec3d& normal = normals[normal_count++];
                return vector("a normal", normal) && not_zero("a normal", normal);
            }
            if (statement.text != "f") {
                pass_over();
                return true;
            }
            uint32_t n = 0;
            bool smooth = true;
            for (; more(); n++) {
                if (n == Limits::vertices - d.vertex_count)
                    return too_many_vertices();
                const uint32_t at = d.vertex_count + n;
                int64_t numbers[3] = {};
                bool has_normal = false;
                if (!corner(numbers, has_normal) || !number_of("vertex", point_count, numbers[0])
                    || (has_normal && !number_of("normal", normal_count, numbers[2])))
                    return false;
                d.vertices[at] = points[numbers[0]] * scale + offset;
                if (largest(d.vertices[at]) > largest_length)
                    return fail(token.at, "the scaled vertex has a coordinate of %.3g; expected %s",
                                largest(d.vertices[at]), length_range.text);
                smooth = smooth && has_normal;
                if (has_normal)
                    d.normals[at] = normals[numbers[2]];
            }
            faces++;
            if (n < 3)
                return fail(statement.at, "a face of %u corners; expected at least 3", n);
            return face(n, smooth);
        });
        return good && (faces != 0 || expected("", "'f' and a face"));
    }
    bool too_many_vertices()
    {
        return fail(statement.at, "too many vertices; expected at most %u (limit 'vertices')", Limits::vertices);
    }

    uint32_t passed_over = 0;
    Token first_passed; // of them

private:
    Token statement;
    uint32_t line = 0; // where it goes on

    template <class F>
    bool for_each_statement(F f)
    {
        while ((statement = token = lexer.next()).kind != TokenKind::end) {
            line = token.at.line;
            if (token.kind != TokenKind::word)
                return expected("", "a word such as 'v' or 'f'");
            if (!f())
                return false;
            if (more() && (statement.text == "v" || statement.text == "vn")) // a weight, a colour
                pass_over();
            while (more())
                ;
        }
        return true;
    }
    void pass_over()
    {
        if (passed_over++ == 0)
            first_passed = statement;
    }
    // Reads the statement's next token, if it has one; behind a `\` it goes on in the next line.
    bool more()
    {
        token = lexer.next();
        if (token.text == "\\") {
            line++;
            token = lexer.next();
        }
        if (token.kind != TokenKind::end && token.at.line == line)
            return true;
        lexer.unread();
        return false;
    }

    // Three numbers in the statement's line.
    bool vector(const char* what, Vec3d& value)
    {
        constexpr const char* parts[] = {"x of ", "y of ", "z of "};
        double* const to[] = {&value.x, &value.y, &value.z};
        for (int i = 0; i < 3; i++) {
            if (!more() && token.kind == TokenKind::number)
                return fail(token.at, "expected %s%s in the line before, found '%s'", parts[i], what,
                            Shown(token.text).text);
            lexer.unread();
            if (!number(what, length_range, *to[i], parts[i]))
                return false;
            vector_at = i == 0 ? token.at : vector_at;
        }
        return true;
    }

    // a, a/b, a//c or a/b/c: the numbers of a vertex, of a place in a picture, and of a normal.
    bool corner(int64_t (&numbers)[3], bool& has_normal)
    {
        const char* at = token.text.data();
        const char* const end = at + token.text.size();
        for (int i = 0; i < 3; i++) {
            const auto read = std::from_chars(at, end, numbers[i]);
            if (read.ec != std::errc() && !(i == 1 && at != end && *at == '/'))
                break;
            at = read.ptr;
            has_normal = i == 2;
            if (at == end)
                return true;
            if (*at++ != '/')
                break;
        }
        return expected("", "a corner such as 3, 3/1, 3//2 or 3/1/2");
    }
    // From 1, or from the end in negative numbers, to an index.
    bool number_of(const char* what, uint32_t count, int64_t& number)
    {
        if (number == 0 || number > count || number < -int64_t{count})
            return fail(token.at, "'%s' names %s %lld; expected one of the %u before it", Shown(token.text).text, what,
                        static_cast<long long>(number), count);
        number = number > 0 ? number - 1 : count + number;
        return true;
    }
};

} // namespace qray::scene
